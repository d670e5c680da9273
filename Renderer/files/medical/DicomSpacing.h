#pragma once
// Even slice positions of a volume whose slices are not evenly spaced, or incomplete.

#include "base/Error.h"
#include "base/Vector.h"

#include <string>
#include <vector>

namespace fenestra::core {

/// Slice of the volume, between two slices of the series: (1 - fraction) * lower + fraction *
/// upper.
struct SliceBlend {
  std::size_t lower = 0, upper = 0; ///< equal for a copy
  double fraction = 0.0;
};

struct SliceSpacing {
  Vec3 step = Vec3::Zero(); ///< from one slice of the volume to the next, LPS mm
  std::vector<SliceBlend> slices = {};
};

/// Slice in messages, with the center of its first voxel.
struct PlacedSlice {
  std::string file;
  Vec3 position; ///< LPS mm
};

/// Spacing of slices that are sorted along `normal`, a unit vector. Slices within half a step of
/// even spacing are copied; a warning says so beyond 2 % of the step. Otherwise the volume has the
/// smallest distance of two slices, or a divisor of the extent that is hardly smaller, and is
/// interpolated, with a warning. Slices within 2 % of a step of a position are copied to it.
/// `sides`: unit vectors along a row and a column; `pixel`: lengths of a voxel along them, mm.
/// Throws Error (input) for two slices at one position, for a slice that is over half a pixel
/// beside the line through the first and the last, and if more than four times as many slices would
/// be needed.
SliceSpacing computeSpacing(const std::vector<PlacedSlice>& slices, const Vec3& normal,
                            const std::array<Vec3, 2>& sides, const std::array<double, 2>& pixel,
                            const std::string& name, std::vector<Message>& warnings);

} // namespace fenestra::core
