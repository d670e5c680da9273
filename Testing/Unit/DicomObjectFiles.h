#pragma once
// Writes DICOM segmentations and structure sets for tests.

#include "DicomFile.h"
#include "base/Vector.h"

#include <functional>
#include <optional>

namespace fenestra::core {

/// SEG or label map, LPS mm.
struct SegFile {
  std::string type = "BINARY"; ///< SegmentationType
  unsigned columns = 9, rows = 7, bits = 1, maximum = 0;
  Mat3 axes = Mat3::Identity(); ///< columns: along a row, along a column, normal
  Vec3 origin = Vec3::Zero();   ///< of slice 0
  double columnSpacing = 1.0, rowSpacing = 1.0, step = 1.0;
  double statedStep = 0.0, thickness = 0.0; ///< 0: not stated
  bool isShared = true;                     ///< orientation and spacing, among the frames
  std::string characterSet = "";
  std::string frameOfReference = ""; ///< uid

  struct Segment {
    unsigned number;
    std::string label;
    std::vector<unsigned> lab = {};
    std::string category = {}, type = {}, region = {}; ///< SCT codes
  };
  std::vector<Segment> segments = {{1, "one"}};

  struct Frame {
    unsigned segment = 1;
    double slice = 0.0; ///< in steps from the origin
    std::function<unsigned(int x, int y)> pixel = [](int, int) { return 1U; };
  };
  std::vector<Frame> frames = {};

  Vec3 locate(double x, double y, double slice) const {
    return origin + axes * Vec3(x * columnSpacing, y * rowSpacing, slice * step);
  }
};

inline dicom::Item makeMeasures(const SegFile& file) {
  using namespace dicom;
  Item measures;
  if (file.thickness > 0.0)
    measures.push_back(makeDecimals(0x00180050, std::vector{file.thickness}));
  if (file.statedStep > 0.0)
    measures.push_back(makeDecimals(0x00180088, std::vector{file.statedStep}));
  measures.push_back(makeDecimals(0x00280030, std::vector{file.rowSpacing, file.columnSpacing}));
  return {makeSequence(0x00209116, {{makeDecimals(0x00200037,
                                                  [&] {
                                                    std::vector<double> numbers;
                                                    for (int axis = 0; axis < 2; ++axis)
                                                      for (int i = 0; i < 3; ++i)
                                                        numbers.push_back(file.axes(i, axis));
                                                    return numbers;
                                                  }())}}),
          makeSequence(0x00289110, {measures})};
}

inline dicom::Element makeSegments(const SegFile& file) {
  using namespace dicom;
  std::vector<Item> items;
  for (const SegFile::Segment& segment : file.segments) {
    Item item;
    if (!segment.region.empty())
      item.push_back(makeCode(0x00082218, "SCT", segment.region));
    if (!segment.category.empty())
      item.push_back(makeCode(0x00620003, "SCT", segment.category));
    item.push_back(makeShorts(0x00620004, {segment.number}));
    item.push_back(makeText(0x00620005, "LO", segment.label));
    if (!segment.lab.empty())
      item.push_back(makeShorts(0x0062000d, segment.lab));
    if (!segment.type.empty())
      item.push_back(makeCode(0x0062000f, "SCT", segment.type));
    items.push_back(item);
  }
  return makeSequence(0x00620002, items);
}

inline dicom::Element makeFrames(const SegFile& file) {
  using namespace dicom;
  std::vector<Item> items;
  for (const SegFile::Frame& frame : file.frames) {
    Item item = {
        makeSequence(0x00209113, {{makeDecimals(0x00200032, file.locate(0, 0, frame.slice))}})};
    if (!file.isShared)
      for (Element& element : makeMeasures(file))
        item.push_back(std::move(element));
    if (file.type != "LABELMAP")
      item.push_back(makeSequence(0x0062000a, {{makeShorts(0x0062000b, {frame.segment})}}));
    items.push_back(item);
  }
  return makeSequence(0x52009230, items);
}

inline dicom::Element makePixels(const SegFile& file, dicom::Syntax syntax) {
  dicom::Element pixels{0x7fe00010, file.bits == 16 || file.bits == 1 ? "OW" : "OB"};
  std::size_t at = 0;
  for (const SegFile::Frame& frame : file.frames) {
    std::string bytes;
    for (unsigned y = 0; y < file.rows; ++y)
      for (unsigned x = 0; x < file.columns; ++x) {
        const unsigned value = frame.pixel(static_cast<int>(x), static_cast<int>(y));
        if (file.bits == 1) {
          if (at % 8 == 0)
            pixels.value += '\0';
          pixels.value.back() = static_cast<char>(static_cast<unsigned char>(pixels.value.back()) |
                                                  value << at++ % 8);
        } else {
          bytes += static_cast<char>(value & 255U);
          if (file.bits == 16)
            bytes += static_cast<char>(value >> 8);
        }
      }
    if (syntax == dicom::Syntax::rle)
      pixels.fragments.push_back(dicom::encodeRle(bytes, file.bits / 8));
    else
      pixels.value += bytes;
  }
  if (syntax == dicom::Syntax::rle)
    pixels.vr = "OB";
  return pixels;
}

inline std::string makeSegFile(const SegFile& file,
                               dicom::Syntax syntax = dicom::Syntax::explicitLittle,
                               bool hasLengths = true) {
  using namespace dicom;
  const bool isLabelMap = file.type == "LABELMAP";
  Item data = {
      makeText(0x00080005, "CS", file.characterSet),
      makeText(0x00080016, "UI",
               isLabelMap ? "1.2.840.10008.5.1.4.1.1.66.7" : "1.2.840.10008.5.1.4.1.1.66.4")};
  data.push_back(makeText(0x00080060, "CS", "SEG"));
  data.push_back(makeText(0x00200052, "UI", file.frameOfReference));
  data.push_back(makeShorts(0x00280002, {1}));
  data.push_back(makeText(0x00280004, "CS", "MONOCHROME2"));
  data.push_back(makeText(0x00280008, "IS", std::to_string(file.frames.size())));
  data.push_back(makeShorts(0x00280010, {file.rows}));
  data.push_back(makeShorts(0x00280011, {file.columns}));
  data.push_back(makeShorts(0x00280100, {file.bits}));
  data.push_back(makeShorts(0x00280101, {file.bits}));
  data.push_back(makeShorts(0x00280102, {file.bits - 1}));
  data.push_back(makeShorts(0x00280103, {0}));
  data.push_back(makeText(0x00620001, "CS", file.type));
  data.push_back(makeSegments(file));
  if (file.maximum > 0)
    data.push_back(makeShorts(0x0062000e, {file.maximum}));
  if (file.isShared)
    data.push_back(makeSequence(0x52009229, {makeMeasures(file)}));
  data.push_back(makeFrames(file));
  data.push_back(makePixels(file, syntax));
  return makeFile(data, syntax, hasLengths);
}

// ---- structure sets

struct RoiFile {
  unsigned number = 1;
  std::string name = "one";
  std::vector<int> color = {255, 0, 0};
  std::vector<std::vector<Vec3>> contours = {}; ///< LPS mm
  std::string type = "CLOSED_PLANAR";
};

inline std::string makeStructureFile(const std::vector<RoiFile>& rois,
                                     dicom::Syntax syntax = dicom::Syntax::implicitLittle,
                                     bool hasNumbers = true) {
  using namespace dicom;
  std::vector<Item> names, contours;
  for (const RoiFile& roi : rois) {
    names.push_back({makeText(0x30060022, "IS", std::to_string(roi.number)),
                     makeText(0x30060026, "LO", roi.name)});
    std::vector<Item> items;
    for (const std::vector<Vec3>& contour : roi.contours) {
      std::vector<double> numbers;
      for (const Vec3& point : contour)
        numbers.insert(numbers.end(), point.begin(), point.end());
      items.push_back({makeText(0x30060042, "CS", roi.type), makeDecimals(0x30060050, numbers)});
    }
    Item item;
    if (!roi.color.empty())
      item.push_back(makeDecimals(0x3006002a, roi.color));
    item.back().vr = "IS";
    item.push_back(makeSequence(0x30060040, items));
    if (hasNumbers)
      item.push_back(makeText(0x30060084, "IS", std::to_string(roi.number)));
    contours.push_back(item);
  }
  return makeFile({makeText(0x00080016, "UI", "1.2.840.10008.5.1.4.1.1.481.3"),
                   makeText(0x00080060, "CS", "RTSTRUCT"), makeSequence(0x30060020, names),
                   makeSequence(0x30060039, contours)},
                  syntax);
}

} // namespace fenestra::core
