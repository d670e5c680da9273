#pragma once
// Color conversions: linear Rec. 709, and sRGB as displays encode it.

#include "base/Vector.h"

#include <cstdint>

namespace fenestra::core {

/// Luminance of linear Rec. 709.
inline double luminance(const Rgb& color) {
  return 0.2126 * color[0] + 0.7152 * color[1] + 0.0722 * color[2];
}

/// Components, 0 to 1, of the color 0xrrggbb.
inline Rgb hexToRgb(std::uint32_t color) {
  const auto byte = [color](unsigned shift) {
    return static_cast<double>((color >> shift) & 0xffU);
  };
  return Rgb(byte(16), byte(8), byte(0)) / 255.0;
}

/// The sRGB electro-optical transfer function (IEC 61966-2-1), per component.
inline Rgb decodeSrgb(const Rgb& encoded) {
  return encoded.unaryExpr(
      [](double v) { return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4); });
}

/// Inverse of decodeSrgb, for linear values from 0 to 1.
inline Rgb encodeSrgb(const Rgb& linear) {
  return linear.unaryExpr([](double v) {
    return v <= 0.04045 / 12.92 ? 12.92 * v : 1.055 * std::pow(v, 1.0 / 2.4) - 0.055;
  });
}

} // namespace fenestra::core
