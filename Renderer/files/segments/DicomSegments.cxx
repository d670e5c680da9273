#include "files/segments/DicomSegments.h"

#include "base/Color.h"
#include "image/ColorVision.h"
#include "io/InputRegistry.h"

#include <algorithm>
#include <set>

namespace fenestra::core {
namespace {

/// Color of RecommendedDisplayCIELabValue (DICOM PS3.3, C.10.7.1.1). The white point is that of
/// sRGB, as dcmqi, 3D Slicer and OHIF write it.
std::optional<Rgb> convertLab(const std::vector<double>& color) {
  if (color.size() != 3)
    return std::nullopt;
  constexpr double scale = 65535.0;
  const Lab lab{100.0 * color[0] / scale, 255.0 * color[1] / scale - 128.0,
                255.0 * color[2] / scale - 128.0};
  return encodeSrgb(toLinear(lab).max(0.0).min(1.0));
}

/// Color of ROIDisplayColor.
std::optional<Rgb> convertBytes(const std::vector<double>& color) {
  if (color.size() != 3)
    return std::nullopt;
  return (Rgb(color[0], color[1], color[2]) / 255.0).max(0.0).min(1.0);
}

/// Label values: the numbers in the file, or 1, 2, ... unless those are different, above 0 and at
/// most `maximum`.
std::vector<std::int32_t> chooseValues(const std::vector<std::int32_t>& numbers,
                                       std::int32_t maximum) {
  const bool areValid =
      std::ranges::all_of(numbers, [&](auto n) { return n > 0 && n <= maximum; }) &&
      std::set(numbers.begin(), numbers.end()).size() == numbers.size();
  std::vector<std::int32_t> values = numbers;
  for (std::size_t i = 0; i < values.size() && !areValid; ++i)
    values[i] = static_cast<std::int32_t>(i + 1);
  return values;
}

SegmentInfo makeInfo(const char* prefix, std::int32_t number, const std::string& name,
                     std::int32_t value, const std::optional<Rgb>& color) {
  SegmentInfo info;
  info.id = concat(prefix, number);
  info.labelValue = value;
  info.name = name.empty() ? info.id : name;
  info.color = color.value_or(info.color);
  return info;
}

template <typename Items>
std::vector<std::int32_t> listNumbers(const Items& items, const std::string& source) {
  constexpr std::size_t maxItems = 32767; // label values have 16 bits
  if (items.empty())
    throw inputError(source, "has no segments; export the segmentation again");
  if (items.size() > maxItems)
    throw inputError(ErrorCode::limitExceeded, source, "has ", items.size(), " segments; at most ",
                     maxItems, " are supported");
  std::vector<std::int32_t> numbers;
  for (const auto& item : items)
    numbers.push_back(item.number);
  return numbers;
}

std::vector<SegmentInfo> makeInfos(const DicomSegmentation& object, const std::string& source) {
  const std::vector<std::int32_t> numbers = listNumbers(object.segments, source);
  if (std::set(numbers.begin(), numbers.end()).size() != numbers.size())
    throw fieldError(source, "SegmentNumber",
                     "is the same for several segments; export the segmentation again");
  const bool isLabelMap = object.type == "LABELMAP";
  const auto values = isLabelMap ? numbers : chooseValues(numbers, 32767);
  std::vector<SegmentInfo> infos;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const DicomSegment& segment = object.segments[i];
    SegmentInfo info =
        makeInfo("Segment_", segment.number, segment.label, values[i], convertLab(segment.color));
    info.category = segment.category;
    info.type = segment.type;
    info.region = segment.region;
    infos.push_back(std::move(info));
  }
  return infos;
}

std::vector<SegmentInfo> makeInfos(const DicomStructureSet& object, const std::string& source) {
  const std::vector<std::int32_t> numbers = listNumbers(object.rois, source);
  const auto values = chooseValues(numbers, 32767);
  std::vector<SegmentInfo> infos;
  for (std::size_t i = 0; i < numbers.size(); ++i)
    infos.push_back(makeInfo("ROI_", numbers[i], object.rois[i].name, values[i],
                             convertBytes(object.rois[i].color)));
  return infos;
}

/// The background of a label map is no segment.
void removeBackground(DicomObject& object) {
  if (auto* const frames = std::get_if<DicomSegmentation>(&object))
    std::erase_if(frames->segments, [&](const DicomSegment& segment) {
      return frames->type == "LABELMAP" && segment.number == 0;
    });
}

DicomObject readObject(DicomObjectReader& files, const std::filesystem::path& path) {
  requireFile(path, "give a DICOM file in it");
  DicomObject object = files.read(path);
  removeBackground(object);
  return object;
}

} // namespace

std::vector<SegmentInfo> makeDicomInfos(const DicomObject& object, const std::string& source) {
  return std::visit([&](const auto& one) { return makeInfos(one, source); }, object);
}

Segmentation readDicomSegments(const std::filesystem::path& path, const Grid* reference) {
  const std::string source = path.string();
  DicomObjectReader files;
  const DicomObject object = readObject(files, path);
  try {
    std::vector<SegmentInfo> infos = makeDicomInfos(object, source);
    if (const auto* const contours = std::get_if<DicomStructureSet>(&object))
      return makeContourLabels(source, *contours, std::move(infos), reference);
    const auto& frames = std::get<DicomSegmentation>(object);
    const auto readFrames = [&](std::uint64_t first, std::uint64_t count) {
      return files.readFrames(path, frames, first, count);
    };
    return makeFrameLabels(readFrames, path, frames, std::move(infos), reference);
  } catch (const std::bad_alloc&) {
    throw inputError(ErrorCode::outOfMemory, source,
                     "does not fit into memory; give fewer segments");
  }
}

std::vector<SegmentInfo> readDicomSegmentInfos(const std::filesystem::path& path) {
  DicomObjectReader files;
  return makeDicomInfos(readObject(files, path), path.string());
}

} // namespace fenestra::core
