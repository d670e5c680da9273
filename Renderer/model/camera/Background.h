#pragma once
// The background behind the volume, as camera rays see it.

#include "model/medium/VolumeProperty.h"

namespace fenestra::core {

struct Background {
  enum class Kind { color, gradient, transparent, environment };
  Kind kind = Kind::color;
  Rgb color = Rgb::Zero();                     ///< linear
  Rgb bottom = Rgb::Zero(), top = Rgb::Zero(); ///< of a gradient; display-encoded (sRGB)

  /// Gradient between display-encoded colors at the image's lower and upper edge, as in Slicer's
  /// views; a uniform color if both are equal.
  static Background makeGradient(const Rgb& bottom, const Rgb& top) {
    if (bottom == top)
      return {Kind::color, decodeSrgb(bottom)};
    return {Kind::gradient, Rgb::Zero(), bottom, top};
  }

  /// Default background: nearly black, as around the spotlight of an operating theater.
  static Background makeDark() { return {Kind::color, Rgb(0.004, 0.0042, 0.005)}; }
  /// Middle gray, on which both dark and light tissue stand out.
  static Background makeGray() { return {Kind::color, Rgb::Constant(0.18)}; }
  /// A dark gray gradient, lighter at the top. The edge colors below are linear.
  static Background makeDarkGradient() {
    return makeGradient(encodeSrgb({0.012, 0.013, 0.016}), encodeSrgb({0.060, 0.066, 0.078}));
  }

  /// Linear color of a gradient at a height from 0 (lower edge) to 1. The encoded colors are
  /// interpolated, as in VTK.
  Rgb evaluate(double height) const { return decodeSrgb(bottom + height * (top - bottom)); }
};

} // namespace fenestra::core
