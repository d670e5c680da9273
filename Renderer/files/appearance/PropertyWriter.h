#pragma once
// Writes a volume property in Slicer's two file formats.

#include "model/medium/VolumeProperty.h"

#include <string>

namespace fenestra::core {

/// Content of a .vp.json (Slicer 5.10 and later). `minimum`, `maximum`: range of the volume's
/// scalars.
std::string encodePropertyJson(const VolumeProperty& property, double minimum, double maximum);

/// Functions of a property as Slicer's strings: the number of values, then x and y (or x, r, g, b)
/// per node. They cannot hold unit distance, midpoint or sharpness (defaults are assumed), so
/// opacities are converted to a unit of 1 mm. That is exact at the nodes. Between nodes it is exact
/// only if both opacities are equal or the unit already is 1 mm.
struct PropertyStrings {
  std::string scalarOpacity, gradientOpacity, color;
};
PropertyStrings encodePropertyStrings(const VolumeProperty& property);

/// Content of a .vp, which every version of Slicer reads.
std::string encodePropertyVp(const VolumeProperty& property);

inline constexpr double ambientLight = 0.1; ///< Slicer's ambient term; Fenestra has none

} // namespace fenestra::core
