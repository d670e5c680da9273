#pragma once
// Bytes of a single-file NIfTI-1 image with any geometry and header extension, which ITK's writer
// cannot produce.

#include "base/Vector.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

namespace fenestra::core {

struct NiftiFile {
  std::array<std::int16_t, 3> size = {3, 4, 2};
  std::vector<std::int16_t> samples = std::vector<std::int16_t>(24, 0);
  std::int16_t qformCode = 0, sformCode = 0;
  std::array<float, 3> quaternion = {0, 0, 0}, quaternionOffset = {0, 0, 0};
  std::array<float, 12> rows = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0}; ///< srow_x, _y, _z
  std::array<float, 4> pixdim = {1, 1, 1, 1};                        ///< the first: qfac
  char units = 2;                                                    ///< millimeters
  std::string extension = {};

  void setSform(const Affine& map) {
    for (std::size_t row = 0; row < 3; ++row)
      for (std::size_t column = 0; column < 4; ++column)
        rows[4 * row + column] = static_cast<float>(
            column < 3 ? map.linear()(std::ptrdiff_t(row), std::ptrdiff_t(column))
                       : map.translation()[std::ptrdiff_t(row)]);
  }

  /// The axes of `map` must be orthogonal.
  void setQform(const Affine& map) {
    Mat3 r = map.linear().normalizedColumns();
    const Vec3 spacing = map.linear().columnNorms();
    pixdim[0] = r.determinant() < 0.0 ? -1.0f : 1.0f;
    if (pixdim[0] < 0.0f)
      r.col(2) = -r.col(2);
    // Starts from the largest component of the quaternion, like nifti_mat44_to_quatern.
    const double trace = r.trace();
    std::array<double, 4> q{};
    const double squares[] = {1.0 + trace, 1.0 + 2.0 * r(0, 0) - trace, 1.0 + 2.0 * r(1, 1) - trace,
                              1.0 + 2.0 * r(2, 2) - trace};
    std::size_t largest = 0;
    for (std::size_t i = 1; i < 4; ++i)
      largest = squares[i] > squares[largest] ? i : largest;
    const double twice = std::sqrt(squares[largest]), s = 0.5 / twice;
    const double skew[] = {r(2, 1) - r(1, 2), r(0, 2) - r(2, 0), r(1, 0) - r(0, 1)};
    q[largest] = 0.5 * twice;
    for (std::size_t i = 1; i < 4; ++i) {
      if (largest == 0) {
        q[i] = s * skew[i - 1];
      } else if (i != largest) {
        q[i] = s * (r(std::ptrdiff_t(i) - 1, std::ptrdiff_t(largest) - 1) +
                    r(std::ptrdiff_t(largest) - 1, std::ptrdiff_t(i) - 1));
      }
    }
    if (largest != 0)
      q[0] = s * skew[largest - 1];
    for (std::size_t i = 0; i < 3; ++i) {
      const double sign = q[0] < 0.0 ? -1.0 : 1.0;
      quaternion[i] = static_cast<float>(sign * q[i + 1]);
      quaternionOffset[i] = static_cast<float>(map.translation()[std::ptrdiff_t(i)]);
      pixdim[i + 1] = static_cast<float>(spacing[std::ptrdiff_t(i)]);
    }
  }

  std::string bytes() const {
    std::string header(348, '\0');
    const auto put = [&header](std::size_t at, const auto& value) {
      std::memcpy(&header[at], &value, sizeof value);
    };
    put(0, std::int32_t{348});
    put(40, std::array<std::int16_t, 8>{3, size[0], size[1], size[2], 1, 1, 1,
                                        1}); // number of axes, sizes
    put(70, std::int16_t{4});                // int16
    put(72, std::int16_t{16});               // bits
    put(76, pixdim);
    // Extension: size (a multiple of 16 that includes these 8 bytes), code and content.
    std::string block;
    if (!extension.empty()) {
      block = std::string(8, '\0') + extension;
      block.resize((block.size() + 15) / 16 * 16, '\0');
      const auto blockSize = static_cast<std::int32_t>(block.size());
      std::memcpy(block.data(), &blockSize, sizeof blockSize);
    }
    put(108, static_cast<float>(352 + block.size())); // offset of the samples
    put(112, 1.0f);                                   // slope
    header[123] = units;
    put(252, qformCode);
    put(254, sformCode);
    put(256, quaternion);
    put(268, quaternionOffset);
    put(280, rows);
    std::memcpy(&header[344], "n+1", 4);
    const std::string extensionFlag(extension.empty() ? "\0\0\0\0" : "\1\0\0\0", 4);
    return header + extensionFlag + block +
           std::string(reinterpret_cast<const char*>(samples.data()), 2 * samples.size());
  }
};

/// Volume along RAS axes whose voxels are stored in another order of axes; axes with a bit in
/// `reversed` are flipped. `map` becomes index to RAS; the file has no qform or sform yet.
template <typename Value>
NiftiFile makeReordered(const Size3& size, const Vec3& spacing, const Vec3& origin, Value&& value,
                        const std::array<int, 3>& order, int reversed, Affine& map) {
  NiftiFile file;
  map = Affine(Mat3::Zero(), origin);
  for (int axis = 0; axis < 3; ++axis) {
    const int world = order[std::size_t(axis)];
    const double sign = reversed >> axis & 1 ? -1.0 : 1.0;
    file.size[std::size_t(axis)] = static_cast<std::int16_t>(size[world]);
    map.linear()(world, axis) = sign * spacing[world];
    if (sign < 0.0)
      map.translation()[world] += spacing[world] * double(size[world] - 1);
    file.pixdim[std::size_t(axis) + 1] = static_cast<float>(spacing[world]);
  }
  file.samples.clear();
  for (int z = 0; z < file.size[2]; ++z)
    for (int y = 0; y < file.size[1]; ++y)
      for (int x = 0; x < file.size[0]; ++x) {
        const Vec3 place = (map * Vec3(x, y, z) - origin).array() / spacing.array();
        const Vec3 voxel = place.array().round();
        file.samples.push_back(value(voxel.cast<std::int64_t>()));
      }
  return file;
}

} // namespace fenestra::core
