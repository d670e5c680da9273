#pragma once
// Background: radiance of an eye ray that passes through the volume.

#include "model/medium/VolumeProperty.h"

namespace fenestra {

struct Background {
  enum class Kind { color, gradient, transparent, environment };
  Kind kind = Kind::color;
  Rgb color = Rgb::Zero();                     ///< linear
  Rgb bottom = Rgb::Zero(), top = Rgb::Zero(); ///< of a gradient: display-encoded (sRGB)

  /// From one display-encoded colour at the picture's lower edge to another at its upper edge, as
  /// Slicer's views have it; a plain colour where both are the same.
  static Background gradient(const Rgb& bottom, const Rgb& top) {
    if ((bottom == top).all())
      return {Kind::color, decodeSrgb(bottom)};
    return {Kind::gradient, Rgb::Zero(), bottom, top};
  }

  /// A gradient's linear colour at a height from 0 (the lower edge) to 1: VTK interpolates the
  /// encoded colours.
  Rgb at(double height) const { return decodeSrgb(bottom + height * (top - bottom)); }
};

} // namespace fenestra
