#pragma once
// The background, shown by eye rays that pass through the volume.

#include "model/medium/VolumeProperty.h"

namespace fenestra {

struct Background {
  enum class Kind { color, gradient, transparent, environment };
  Kind kind = Kind::color;
  Rgb color = Rgb::Zero();                     ///< linear
  Rgb bottom = Rgb::Zero(), top = Rgb::Zero(); ///< of a gradient; display-encoded (sRGB)

  /// Gradient between display-encoded colours at the picture's lower and upper edge, like Slicer's
  /// views; a plain colour if both are equal.
  static Background makeGradient(const Rgb& bottom, const Rgb& top) {
    if (bottom == top)
      return {Kind::color, decodeSrgb(bottom)};
    return {Kind::gradient, Rgb::Zero(), bottom, top};
  }

  /// Background where nobody says one: a dark grey, so that dark organs stand off and the end of a
  /// scan is no hole, lighter at the top. The colours of its edges are linear; between them their
  /// encoded values are interpolated, as in any gradient.
  static Background makeDefault() {
    return makeGradient(encodeSrgb({0.012, 0.013, 0.016}), encodeSrgb({0.060, 0.066, 0.078}));
  }

  /// Linear colour of a gradient at a height from 0 (the lower edge) to 1: the encoded colours are
  /// interpolated, as in VTK.
  Rgb evaluate(double height) const { return decodeSrgb(bottom + height * (top - bottom)); }
};

} // namespace fenestra
