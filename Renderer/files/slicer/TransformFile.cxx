#include "files/slicer/TransformFile.h"

#include "base/Checked.h"
#include "base/safe/Inputs.h"
#include "base/safe/JsonNode.h"
#include "files/medical/Quiet.h"
#include "files/slicer/TransformMatrix.h"
#include "files/slicer/TransformRecords.h"

#include <new>

namespace fenestra {
namespace {

using Path = std::filesystem::path;

constexpr std::uint64_t largestFile = 64 << 20;
constexpr std::uint64_t largestTextFile = 1 << 20; ///< room for hundreds of matrices

/// Product of the file's transforms, in LPS, in the file's own sense.
Affine composed(const Path& path, const std::vector<TransformRecord>& records) {
  if (records.empty())
    throwDamagedTransform(path);
  if (records.front().type != "CompositeTransform") {
    if (records.size() > 1)
      throw inputError(path, "holds ", records.size(),
                       " transforms and does not say how they combine; save one, or a composite");
    return transformMatrix(path, records.front());
  }
  Affine map = Affine::Identity();
  for (std::size_t i = 1; i < records.size(); ++i)
    map = map * transformMatrix(path, records[i]);
  return map;
}

void checkExtension(const Path& path) {
  const std::string extension = lowerExtension(path);
  for (const char* known : {".tfm", ".txt", ".h5", ".hdf5", ".mat"})
    if (extension == known)
      return;
  for (const char* image : {".nrrd", ".nhdr", ".nii", ".gz", ".mha", ".mhd"})
    if (extension == image)
      throw inputError(path, "is a displacement field, which is not linear; harden it in Slicer "
                             "(Data module, Harden transform) and save again");
  throw inputError(
      path, "has no known extension of a transform; name a .tfm, .txt, .h5, .hdf5 or .mat file");
}

/// Refuses texts that name further files: ITK would open them.
void checkNamesNoFile(const Path& path) {
  if (readText(path, largestFile).find("ComponentTransformFile") != std::string::npos)
    throw inputError(
        path, "ComponentTransformFile: further files are not read; save the composite in one file");
}

} // namespace

Affine readLinearTransform(const Path& path, TransformSense sense) {
  requireFile(path, "name a transform file in it");
  const std::string extension = lowerExtension(path);
  const bool isText = extension == ".tfm" || extension == ".txt";
  const std::uint64_t largest = isText ? largestTextFile : largestFile;
  if (std::filesystem::file_size(path) > largest)
    throw inputError(path, "is larger than ", largest >> 20,
                     " MB, so it is no linear transform; harden it in Slicer (Data module, Harden "
                     "transform) and save again");
  checkExtension(path);
  checkNamesNoFile(path);
  return answeredTransform(path, transformAnswer(path), sense);
}

Affine answeredTransform(const Path& path, std::string_view answer, TransformSense sense) {
  try {
    const Quiet quiet;
    Affine map = checkedMap(
        composed(path, transformRecords(path, answer)), [&path](const std::string& what) {
          return inputError(path, "Parameters: the map ", what, "; save another one");
        });
    if (sense == TransformSense::fromParent)
      map = map.inverse();
    return Affine(lpsToRas * map.linear() * lpsToRas, lpsToRas * map.translation());
  } catch (const Error&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception&) { // ITK's: a matrix that its class forbids; AnswerReader's: a
                                    // malformed answer
    throwDamagedTransform(path);
  }
}

} // namespace fenestra
