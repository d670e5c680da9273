#include "files/slicer/TransformFile.h"

#include "base/Checked.h"
#include "base/safe/Apart.h"
#include "base/safe/Inputs.h"
#include "base/safe/JsonNode.h"
#include "base/safe/ShownText.h"
#include "files/medical/Quiet.h"
#include "files/slicer/TransformAnswer.h"

#include <itkMatrixOffsetTransformBase.h>
#include <itkRigid3DTransform.h>
#include <itkTransformFactory.h>

#include <new>

namespace fenestra {
namespace {

using Path = std::filesystem::path;

constexpr const char* hardened =
    "harden it in Slicer (Data module, Harden transform) and save again";
constexpr std::uint64_t largestFile = 64 << 20;
constexpr std::uint64_t largestTextFile = 1 << 20; ///< room for hundreds of matrices

struct Record {
  std::string type;               ///< ITK's name without scalar type and axes: "AffineTransform"
  std::vector<double> parameters; ///< in the order of ITK's class of that name
  std::vector<double> fixed;      ///< fixed parameters: mostly the centre
};

[[noreturn]] void throwDamaged(const Path& path) {
  throw inputError(path, "is damaged, truncated or no transform of ITK's; save it again");
}

/// Transforms that ITK computes a matrix and an offset for.
using MatrixTransform = itk::MatrixOffsetTransformBase<double, 3, 3>;

/// ITK's own of this type; null: none.
MatrixTransform::Pointer matrixTransform(const std::string& type) {
  [[maybe_unused]] static const bool known = [] {
    itk::TransformFactoryBase::RegisterDefaultTransforms();
    itk::TransformFactory<itk::Rigid3DTransform<double>>::RegisterTransform();
    return true;
  }();
  const auto made = itk::ObjectFactoryBase::CreateInstance((type + "_double_3_3").c_str());
  if (!made)
    return nullptr;
  made->UnRegister(); // CreateInstance counts one reference too many
  return dynamic_cast<MatrixTransform*>(made.GetPointer());
}

/// "Type" of "Type_scalar_axes_axes". Throws Error (input) unless linear and of three axes.
std::string linearType(const Path& path, const std::string& name) {
  std::string type = name.substr(0, name.find('_'));
  const bool isSimple =
      type == "CompositeTransform" || type == "IdentityTransform" || type == "TranslationTransform";
  if (!isSimple && !matrixTransform(type))
    throw inputError(path, "Transform: ", shown(name), " is not linear; ", hardened);
  if (name != type + "_double_3_3") // ITK's readers turn _float_ into _double_
    throw inputError(path, "Transform: ", shown(name),
                     " is not a transform of three axes; save one that is");
  return type;
}

/// Records in the answer, which is untrusted. Throws std::runtime_error where it is malformed.
std::vector<Record> recordsIn(const Path& path, std::string_view answer) {
  std::vector<Record> records;
  for (AnswerReader reader(answer); !reader.atEnd();)
    records.push_back({linearType(path, reader.text()), reader.numbers(), reader.numbers()});
  return records;
}

/// Map of a record, in the file's own space and sense. Throws ITK's exceptions for values that the
/// type forbids (a rigid matrix that is not orthogonal).
Affine mapOf(const Path& path, const Record& record) {
  if (record.type == "IdentityTransform")
    return Affine::Identity();
  const std::vector<double>&numbers = record.parameters, &fixed = record.fixed;
  if (record.type == "TranslationTransform" && numbers.size() == 3)
    return translationBy({numbers[0], numbers[1], numbers[2]});
  const auto transform = matrixTransform(record.type);
  if (!transform) // a composite within a composite
    throwDamaged(path);
  // Euler angles may have a fourth fixed parameter, the order of the axes.
  const std::size_t mostFixed = std::max<std::size_t>(3, transform->GetFixedParameters().size());
  if (numbers.size() != transform->GetNumberOfParameters() ||
      (!fixed.empty() && (fixed.size() < 3 || fixed.size() > mostFixed)))
    throwDamaged(path);
  const auto fill = [](auto array, const std::vector<double>& values) {
    array.SetSize(static_cast<unsigned>(values.size()));
    std::copy(values.begin(), values.end(), array.begin());
    return array;
  };
  if (!fixed.empty())
    transform->SetFixedParameters(fill(transform->GetFixedParameters(), fixed));
  transform->SetParameters(fill(transform->GetParameters(), numbers));
  transform->SetCenter(transform->GetCenter()); // recomputes the offset, which some classes do not
  Affine map;
  for (unsigned row = 0; row < 3; ++row) {
    for (unsigned column = 0; column < 3; ++column)
      map.linear()(row, column) = transform->GetMatrix()(row, column);
    map.translation()[row] = transform->GetOffset()[row];
  }
  return map;
}

/// Product of the file's transforms, in LPS, in the file's own sense.
Affine composed(const Path& path, const std::vector<Record>& records) {
  if (records.empty())
    throwDamaged(path);
  if (records.front().type != "CompositeTransform") {
    if (records.size() > 1)
      throw inputError(path, "holds ", records.size(),
                       " transforms and does not say how they combine; save one, or a composite");
    return mapOf(path, records.front());
  }
  Affine map = Affine::Identity();
  for (std::size_t i = 1; i < records.size(); ++i)
    map = map * mapOf(path, records[i]);
  return map;
}

void checkExtension(const Path& path) {
  const std::string extension = lowerExtension(path);
  for (const char* known : {".tfm", ".txt", ".h5", ".hdf5", ".mat"})
    if (extension == known)
      return;
  for (const char* image : {".nrrd", ".nhdr", ".nii", ".gz", ".mha", ".mhd"})
    if (extension == image)
      throw inputError(path, "is a displacement field, which is not linear; ", hardened);
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
    throw inputError(path, "is larger than ", largest >> 20, " MB, so it is no linear transform; ",
                     hardened);
  checkExtension(path);
  checkNamesNoFile(path);
  return answeredTransform(path, transformAnswer(path), sense);
}

Affine answeredTransform(const Path& path, std::string_view answer, TransformSense sense) {
  try {
    const Quiet quiet;
    Affine map =
        checkedMap(composed(path, recordsIn(path, answer)), [&path](const std::string& what) {
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
    throwDamaged(path);
  }
}

} // namespace fenestra
