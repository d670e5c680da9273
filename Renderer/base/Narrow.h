#pragma once
// Conversions from double to the floats that SIMD code reads.

#include "base/Vector.h"

#include <array>

namespace fenestra::core {

inline float narrow(double x) {
  return static_cast<float>(x);
}

template <typename Triple>
std::array<float, 3> narrow3(const Triple& v) {
  return {narrow(v[0]), narrow(v[1]), narrow(v[2])};
}

/// A row of an affine map, translation last.
using AffineRow = std::array<float, 4>;
using AffineRows = std::array<AffineRow, 3>;

inline AffineRows affineRows(const Affine& map) {
  AffineRows rows;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 4; ++j)
      rows[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)] =
          narrow(j < 3 ? map.linear()(i, j) : map.translation()[i]);
  return rows;
}

} // namespace fenestra::core
