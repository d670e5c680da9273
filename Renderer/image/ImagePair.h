#pragma once
// Two images of the same size, for comparison.

#include "image/Image.h"

#include <array>

namespace fenestra::core {

inline constexpr std::array<const char*, 3> colorNames = {"R", "G", "B"};
inline constexpr std::array<const char*, 3> errorNames = {"error.R", "error.G", "error.B"};

/// Three planes of an image; null if missing.
using Planes = std::array<const std::vector<float>*, 3>;

Planes findPlanes(const Image& image, const std::array<const char*, 3>& names);

inline bool isComplete(const Planes& planes) {
  return planes[0] && planes[1] && planes[2];
}

/// Planes of R, G and B. Throws Error (input) if one is missing.
Planes findColors(const Image& image);

/// Throws Error (input) for different sizes.
void requireSameSize(const Image& a, const Image& b);

constexpr double square(double x) {
  return x * x;
}

/// Channels of two images that are compared.
struct ImagePair {
  Planes a, b, errorA, errorB;
  std::size_t pixels;

  /// Throws Error (input) for different sizes or missing colors.
  ImagePair(const Image& imageA, const Image& imageB)
      : a(findColors(imageA)),
        b(findColors(imageB)),
        errorA(findPlanes(imageA, errorNames)),
        errorB(findPlanes(imageB, errorNames)),
        pixels(a[0]->size()) {
    requireSameSize(imageA, imageB);
  }

  bool hasErrors() const { return isComplete(errorA) && isComplete(errorB); }
  double difference(std::size_t c, std::size_t i) const {
    return static_cast<double>((*a[c])[i]) - static_cast<double>((*b[c])[i]);
  }
  double variance(std::size_t c, std::size_t i) const {
    return square((*errorA[c])[i]) + square((*errorB[c])[i]);
  }
  double rounding(std::size_t c, std::size_t i) const {
    return 0x1p-24 * std::max(std::abs((*a[c])[i]), std::abs((*b[c])[i]));
  }
  /// True if the values are equal up to float rounding.
  bool isEqual(std::size_t c, std::size_t i) const {
    return std::abs(difference(c, i)) <= 2.0 * rounding(c, i);
  }
  /// True for values that z excludes, since they carry no statistical information: both errors are
  /// 0, or one is 0 and the values are equal (background); up to float rounding.
  bool isUninformative(std::size_t c, std::size_t i) const {
    const bool exactA = std::abs((*errorA[c])[i]) <= rounding(c, i);
    const bool exactB = std::abs((*errorB[c])[i]) <= rounding(c, i);
    return (exactA && exactB) || ((exactA || exactB) && isEqual(c, i));
  }
};

} // namespace fenestra::core
