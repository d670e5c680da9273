#pragma once
// Basic types of Fenestra's public interface. World coordinates are RAS, millimeters.

#include <array>
#include <cstdint>

#define FENESTRA_EXPORT __attribute__((visibility("default")))

namespace fenestra {
inline namespace v1 { // interfaces of different versions cannot be mixed by accident

using Vector3 = std::array<double, 3>;
/// Linear Rec. 709, unless stated otherwise.
using Color = std::array<double, 3>;

/// Index (i, j, k) of a voxel center to RAS mm: the first three rows of a 4x4 matrix, as
/// `affine[:3]` of nibabel. The matrix must be invertible.
using Affine = std::array<std::array<double, 4>, 3>;

enum class SampleType {
  int8,
  uint8,
  int16,
  uint16,
  int32,
  uint32,
  int64,
  uint64,
  float32,
  float64
};

/// Samples in the caller's memory, one per voxel. They are read once, by the function that gets
/// them.
struct Samples {
  const void* data = nullptr; ///< the sample at index (0, 0, 0)
  SampleType type = SampleType::int16;
  std::array<std::int64_t, 3> size = {}; ///< voxels along i, j, k
  /// Bytes from a sample to the next one along i, j, k; all 0: packed, i fastest.
  std::array<std::int64_t, 3> strides = {};
  bool isSwapped = false; ///< byte order differs from the machine's
};

} // namespace v1
} // namespace fenestra
