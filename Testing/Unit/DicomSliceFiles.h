#pragma once
// Writes DICOM slices and multi-frame files for tests.

#include "DicomObjectFiles.h"
#include "MedicalFiles.h"
#include "files/medical/DicomSeries.h"

#include <functional>

namespace fenestra::core::dicomSlices {

using Path = std::filesystem::path;
using dicom::Element;
using dicom::Item;
using dicom::makeDecimals;
using dicom::makeSequence;
using dicom::makeShorts;
using dicom::makeText;
using dicom::Syntax;

inline constexpr const char* ctClass = "1.2.840.10008.5.1.4.1.1.2";
inline constexpr const char* enhancedCtClass = "1.2.840.10008.5.1.4.1.1.2.1";

inline Element makeDouble(std::uint32_t tag, double number) {
  return {tag, "FD", std::string(reinterpret_cast<const char*>(&number), sizeof number)};
}

inline std::vector<double> toCosines(const Mat3& axes) {
  std::vector<double> numbers;
  for (int axis = 0; axis < 2; ++axis)
    for (int i = 0; i < 3; ++i)
      numbers.push_back(axes(i, axis));
  return numbers;
}

/// 3 x 2 voxels of one value. Elements of `more` are added, and replace those with the same tag.
struct Slice {
  double value = 0.0;
  Vec3 position = Vec3::Zero();
  std::string seriesUid = "1.2.3", sopUid = "";
  int instance = 0;
  Mat3 axes = Mat3::Identity();
  std::vector<Element> more = {};
  unsigned columns = 3, rows = 2;
};

inline std::string makePixels(const Slice& slice) {
  std::string pixels;
  for (unsigned i = 0; i < slice.rows * slice.columns; ++i) {
    const auto value = static_cast<std::int16_t>(slice.value);
    pixels.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
  return pixels;
}

/// `data` with the elements of `more`, sorted by tag.
inline Item merge(Item data, const std::vector<Element>& more) {
  for (const Element& element : more) {
    std::erase_if(data, [&](const Element& old) { return old.tag == element.tag; });
    data.push_back(element);
  }
  std::ranges::stable_sort(data, {}, &Element::tag);
  return data;
}

inline Item makeImageElements(const Slice& slice) {
  return {makeShorts(0x00280002, {1}),          makeText(0x00280004, "CS", "MONOCHROME2"),
          makeShorts(0x00280010, {slice.rows}), makeShorts(0x00280011, {slice.columns}),
          makeShorts(0x00280100, {16}),         makeShorts(0x00280101, {16}),
          makeShorts(0x00280102, {15}),         makeShorts(0x00280103, {1})};
}

inline std::string makeSlice(const Slice& slice, Syntax syntax = Syntax::explicitLittle) {
  Item data =
      merge(makeImageElements(slice), {makeText(0x00080016, "UI", ctClass),
                                       makeText(0x00080018, "UI", slice.sopUid),
                                       makeText(0x00080060, "CS", "CT"),
                                       makeText(0x0020000e, "UI", slice.seriesUid),
                                       makeText(0x00200011, "IS", "4"),
                                       makeText(0x00200013, "IS", std::to_string(slice.instance)),
                                       makeDecimals(0x00200032, slice.position),
                                       makeDecimals(0x00200037, toCosines(slice.axes)),
                                       makeDecimals(0x00280030, std::vector{2.0, 0.5}),
                                       makeDecimals(0x00281052, std::vector{-1000.0}),
                                       makeDecimals(0x00281053, std::vector{2.0}),
                                       {0x7fe00010, "OW", makePixels(slice)}});
  return makeFile(merge(std::move(data), slice.more), syntax);
}

/// Volume whose only series is in the folder.
inline Volume read(const Path& folder, const VolumeChoice& choice = {}) {
  const DicomFolder found = findDicomSeries(folder);
  return readDicomVolume(chooseSeries(found.series, choice.name, folder.string()), choice);
}

/// Scalar of the first voxel of a slice; HU as makeSlice stores them.
inline double getScalar(const Volume& volume, std::int64_t slice) {
  const auto i = static_cast<std::size_t>(slice * volume.grid.size.x() * volume.grid.size.y());
  return std::visit([i](const auto& voxels) { return static_cast<double>(voxels[i]); },
                    volume.voxels);
}

inline std::vector<double> getScalars(const Volume& volume) {
  std::vector<double> scalars;
  for (std::int64_t z = 0; z < volume.grid.size.z(); ++z)
    scalars.push_back((getScalar(volume, z) + 1000.0) / 2.0);
  return scalars;
}

inline std::size_t countWarnings(const Volume& volume, ErrorCode code) {
  return static_cast<std::size_t>(
      std::ranges::count(volume.warnings, code, [](const Message& m) { return m.code; }));
}

/// Writes slices at these positions along z; their values are their indices.
inline void writeDepths(const TemporaryFolder& folder, const std::vector<double>& depths) {
  for (std::size_t i = 0; i < depths.size(); ++i)
    folder.write(std::to_string(i), makeSlice({.value = static_cast<double>(i),
                                               .position = Vec3(0, 0, depths[i]),
                                               .instance = static_cast<int>(i)}));
}

// ---- multi-frame files

/// File of frames with the values 0, 1, ... and the functional groups that `groups` returns.
inline std::string makeFrames(unsigned count, const std::function<Item(unsigned)>& groups,
                              const std::vector<Element>& more,
                              Syntax syntax = Syntax::explicitLittle, bool hasLengths = true) {
  std::string pixels;
  std::vector<Item> frames;
  std::vector<std::string> fragments;
  for (unsigned i = 0; i < count; ++i) {
    const std::string frame = makePixels({.value = 1.0 * i});
    pixels += frame;
    if (syntax == Syntax::rle)
      fragments.push_back(dicom::encodeRle(frame, 2));
    if (groups)
      frames.push_back(groups(i));
  }
  Item data = merge(makeImageElements({}),
                    {makeText(0x00080016, "UI", enhancedCtClass),
                     makeText(0x00080060, "CS", "CT"),
                     makeText(0x0020000e, "UI", "1.2.3"),
                     makeText(0x00280008, "IS", std::to_string(count)),
                     {0x7fe00010, fragments.empty() ? "OW" : "OB", pixels, {}, fragments}});
  if (groups)
    data = merge(std::move(data), {makeSequence(0x52009230, frames)});
  return makeFile(merge(std::move(data), more), syntax, hasLengths);
}

inline Element makePosition(const Vec3& position) {
  return makeSequence(0x00209113, {{makeDecimals(0x00200032, position)}});
}

/// Shared groups: orientation, spacing and rescaling.
inline Element makeShared(const Mat3& axes) {
  return makeSequence(
      0x52009229, {{makeSequence(0x00209116, {{makeDecimals(0x00200037, toCosines(axes))}}),
                    makeSequence(0x00289110, {{makeDecimals(0x00280030, std::vector{2.0, 0.5})}}),
                    makeSequence(0x00289145, {{makeDecimals(0x00281052, std::vector{-1000.0}),
                                               makeDecimals(0x00281053, std::vector{2.0})}})}});
}

} // namespace fenestra::core::dicomSlices
