#pragma once
// A volume property in Slicer's two file formats.

#include "model/medium/VolumeProperty.h"

#include <string>

namespace fenestra {

/// Content of a .vp.json (Slicer 5.10 and later). `minimum`, `maximum`: range of the volume's
/// scalars.
std::string encodePropertyJson(const VolumeProperty& property, double minimum, double maximum);

/// Functions of a property as Slicer's strings: number of values, then x and y (or x, r, g, b) per
/// node. The strings hold no unit distance, midpoint or sharpness (defaults are assumed): opacities
/// are converted to a unit of 1 mm, exactly at the nodes; between nodes exactly only where the two
/// are equal, or the unit is 1 mm already.
struct PropertyStrings {
  std::string scalarOpacity, gradientOpacity, color;
};
PropertyStrings encodePropertyStrings(const VolumeProperty& property);

/// Content of a .vp, which every Slicer reads.
std::string encodePropertyVp(const VolumeProperty& property);

inline constexpr double ambientLight = 0.1; ///< ambient term of Slicer's files; Fenestra has none

} // namespace fenestra
