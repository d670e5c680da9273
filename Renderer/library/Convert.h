#pragma once
// Conversions between the public interface and the renderer's own types, and the guard around every
// call from outside.

#include "base/CheckAffine.h"
#include "fenestra/Segmentation.h"
#include "files/medical/ArraySource.h"
#include "files/medical/VolumeChoice.h"
#include "files/segments/SegmentationReader.h"
#include "io/Sandbox.h"
#include "io/platform/ProcessState.h"
#include "model/volume/Grid.h"

#include <memory>
#include <vector>

namespace fenestra {
inline namespace v1 {

inline std::vector<Segment> toSegments(const std::vector<core::SegmentInfo>& infos) {
  std::vector<Segment> segments;
  for (const core::SegmentInfo& info : infos)
    segments.push_back({info.id, info.name, info.labelValue});
  return segments;
}

inline Warning toWarning(const core::Message& message) {
  return {std::string(core::toString(message.code)), message.subject, message.detail};
}

inline std::vector<Warning> toWarnings(const std::vector<core::Message>& messages) {
  std::vector<Warning> warnings;
  for (const core::Message& message : messages)
    warnings.push_back(toWarning(message));
  return warnings;
}

inline Error toError(const core::Error& error) {
  const auto kind = error.kind() == core::ErrorKind::request ? ErrorKind::request
                    : error.kind() == core::ErrorKind::input ? ErrorKind::input
                                                             : ErrorKind::output;
  return {kind, toWarning(error.message())};
}

/// Returns work(), with the renderer's errors as public ones. Throws Error (output) in a process
/// that was forked from one that used this library: threads do not survive a fork, so that it would
/// wait for them forever.
template <typename Work>
auto guard(Work&& work) {
  if (core::isForkedProcess())
    throw Error(ErrorKind::output, {"forked-process", "process",
                                    "was forked from one that used Fenestra; start it again"});
  try {
    return work();
  } catch (const core::Error& error) {
    throw toError(error);
  }
}

inline core::Vec3 toVec3(const Vector3& v) {
  return {v[0], v[1], v[2]};
}
inline Vector3 toVector3(const core::Vec3& v) {
  return {v.x(), v.y(), v.z()};
}

inline core::Affine toCoreAffine(const Affine& rows) {
  core::Mat3 linear;
  core::Vec3 translation;
  for (int row = 0; row < 3; ++row) {
    const auto& from = rows[static_cast<std::size_t>(row)];
    for (int column = 0; column < 3; ++column)
      linear(row, column) = from[static_cast<std::size_t>(column)];
    translation[row] = from[3];
  }
  return core::Affine(linear, translation);
}

inline Affine toAffine(const core::Affine& map) {
  Affine rows;
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 4; ++column)
      rows[static_cast<std::size_t>(row)][static_cast<std::size_t>(column)] =
          column < 3 ? map.linear()(row, column) : map.translation()[row];
  return rows;
}

inline core::SampleType toSampleType(SampleType type) {
  switch (type) {
  case SampleType::int8:
    return std::int8_t();
  case SampleType::uint8:
    return std::uint8_t();
  case SampleType::int16:
    return std::int16_t();
  case SampleType::uint16:
    return std::uint16_t();
  case SampleType::int32:
    return std::int32_t();
  case SampleType::uint32:
    return std::uint32_t();
  case SampleType::int64:
    return std::int64_t();
  case SampleType::uint64:
    return std::uint64_t();
  case SampleType::float32:
    return float();
  case SampleType::float64:
    break;
  }
  return double();
}

inline core::VolumeChoice makeChoice(const ReadOptions& options) {
  core::VolumeChoice choice{.name = options.volume, .frame = options.frame};
  if (options.spacing)
    choice.spacing = toVec3(*options.spacing);
  return choice;
}

/// While the result lives, this thread reads files in this process if `isInProcess`.
inline std::unique_ptr<core::InProcessReading> allowReading(bool isInProcess) {
  return isInProcess ? std::make_unique<core::InProcessReading>() : nullptr;
}

/// Throws core::Error (input), which names `subject`.
core::SampleArray toArray(const Samples& samples, const std::string& subject);
core::Grid makeGrid(const Samples& samples, const Affine& indexToWorld, const std::string& subject);

} // namespace v1
} // namespace fenestra
