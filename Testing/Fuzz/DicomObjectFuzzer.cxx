// DICOM SEG and RTSTRUCT: the input is the reply of the sandboxed child, as in DicomFuzzer.cxx,
// after a byte that selects whether there is a volume. The pixels of a SEG are made here.
#include "Harness.h"

#include "files/segments/DicomSegments.h"

namespace {

using namespace fenestra::core;

DicomObject parseObject(std::string_view reply, const std::string& source) {
  try {
    return parseDicomObject(reply, source);
  } catch (const Error&) {
    throw;
  } catch (const std::runtime_error&) { // as DicomObjectReader does
    throw inputError(source, "is not a valid reply");
  }
}

const Grid* chooseVolume(std::string_view& input) {
  static const Grid volume(Size3(24, 20, 16),
                           Affine(Mat3::Diagonal(Vec3(-1, -1, 2)), Vec3(9, 9, 0)));
  return fuzzing::chooseName(input, std::array{"no", "yes"}) == "yes" ? &volume : nullptr;
}

} // namespace

FENESTRA_FUZZ(DicomSegments, input) {
  const Grid* const volume = chooseVolume(input);
  const auto path = fuzzing::writeInput(input, "seg.dcm");
  const DicomObject object = parseObject(input, path.string());
  const auto* const frames = std::get_if<DicomSegmentation>(&object);
  if (!frames)
    return;
  const auto readFrames = [&](std::uint64_t first, std::uint64_t count) {
    const std::uint64_t bits = static_cast<std::uint64_t>(frames->rows) *
                               static_cast<std::uint64_t>(frames->columns) *
                               static_cast<std::uint64_t>(frames->bits);
    return std::string(((first + count) * bits + 7) / 8 - first * bits / 8, '\x5a');
  };
  makeFrameLabels(readFrames, path, *frames, makeDicomInfos(object, path.string()), volume);
}

FENESTRA_FUZZ(Structures, input) {
  const Grid* const volume = chooseVolume(input);
  const DicomObject object = parseObject(input, "structures.dcm");
  if (const auto* const contours = std::get_if<DicomStructureSet>(&object))
    makeContourLabels("structures.dcm", *contours, makeDicomInfos(object, "structures.dcm"),
                      volume);
}
