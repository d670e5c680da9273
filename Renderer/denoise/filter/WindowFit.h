#pragma once
// Guided filter with several guides (He, Sun and Tang 2010) for one size of windows: colours are
// fitted as linear functions of the features in every window, and a pixel gets the mean over all
// windows that contain it. Windows are 5x5 cells of 2^level pixels: sums over cells are additive,
// so every size costs about the same, and a picture is worked on in tiles, so that memory stays
// small.

#include "denoise/filter/FilterInput.h"
#include "denoise/filter/WindowSums.h"

namespace fenestra {

/// Planes as the fit takes them: 0 where the pixel is not open.
struct FitInput {
  int width = 0, height = 0;
  Plane active;                ///< 1 or 0
  std::vector<Plane> features; ///< mean 0 and deviation 1 over the open pixels
  std::vector<Plane> color;    ///< channels of one half, then those of the other
};

/// Cells of a tile, on which one thread works: with three windows more on each side its rows are
/// four blocks of 16 fits.
constexpr int tileColumns = 58, tileRows = 116;

/// Fits all colours at once, each from itself alone. Closed pixels keep their colour. Independent
/// of threads.
std::vector<Plane> fitWindows(const FitInput& input, int level);

} // namespace fenestra
