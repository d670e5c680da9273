#pragma once
// Memory layout of a window's sums and coefficients, for k features and m colors.

#include <cstddef>

namespace fenestra::core {

struct SumLayout {
  static constexpr std::size_t maxFeatures = 12;
  std::size_t features; ///< k
  std::size_t colors;   ///< m

  static constexpr std::size_t pixelCount = 0; ///< index in both the sums and the coefficients
  /// Sums of 1 (the pixel count), of each feature, of the products of two features, of each color,
  /// and of the products of a feature and a color.
  std::size_t sums() const { return featureColor(features, 0); }
  std::size_t feature(std::size_t i) const { return 1 + i; }
  /// For i <= j.
  std::size_t product(std::size_t i, std::size_t j) const {
    return 1 + features + i * features - i * (i + 1) / 2 + j;
  }
  std::size_t color(std::size_t c) const {
    return 1 + features + features * (features + 1) / 2 + c;
  }
  std::size_t featureColor(std::size_t i, std::size_t c) const {
    return color(colors) + i * colors + c;
  }

  /// Coefficients: the pixel count, then per color an intercept and k slopes.
  std::size_t coefficients() const { return intercept(colors); }
  std::size_t intercept(std::size_t c) const { return 1 + c * (features + 1); }
  std::size_t slope(std::size_t c, std::size_t i) const { return intercept(c) + 1 + i; }
};

} // namespace fenestra::core
