#pragma once
// A volume property in Slicer's two file formats.

#include "model/medium/VolumeProperty.h"

#include <string>

namespace fenestra {

/// The content of a .vp.json, which Slicer reads from 5.10 on. `effectiveRange` is the volume's
/// scalars' range.
std::string propertyJson(const VolumeProperty& property, double minimum, double maximum);

/// The three functions of a property as Slicer's strings: the number of values, then x and y, or x
/// and three colours, of each node. They know neither a unit distance nor the nodes' midpoint and
/// sharpness (here default): opacities are those of 1 mm, right at the nodes, and between them
/// where they are equal or the unit is 1 mm already.
struct PropertyTexts {
  std::string scalarOpacity, gradientOpacity, color;
};
PropertyTexts propertyTexts(const VolumeProperty& property);

/// The content of a .vp, which every Slicer reads.
std::string propertyVp(const VolumeProperty& property);

inline constexpr double ambientLight = 0.1; ///< what Slicer's files say; Fenestra knows none

} // namespace fenestra
