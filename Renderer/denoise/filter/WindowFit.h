#pragma once
// Guided filter with several guides (He, Sun and Tang 2010) for one window size. Colors are fitted
// as linear functions of the features in every window, and a pixel is the mean over all windows
// that contain it. Windows are 5x5 cells of 2^level pixels. Sums over cells are additive, so that
// all sizes cost about the same. The image is processed in tiles to save memory.

#include "denoise/filter/FilterInput.h"
#include "denoise/filter/WindowSums.h"

namespace fenestra::core {

/// Planes for the fit; 0 at inactive pixels.
struct FitInput {
  int width = 0, height = 0;
  Plane active;                         ///< 1 or 0
  std::vector<Plane> features;          ///< mean 0 and standard deviation 1 over the active pixels
  std::vector<Plane> color;             ///< channels of the first half buffer, then of the second
  const StopFlag* stop = &neverStopped; ///< FilterInput::stop
};

/// Cells of a tile, which one thread processes. With three more windows on each side, a row has 64
/// fits, four blocks of 16.
constexpr int tileColumns = 58, tileRows = 116;

/// Fits all colors, independently of each other. Inactive pixels keep their color. Independent of
/// the number of threads.
std::vector<Plane> fitWindows(const FitInput& input, int level);

} // namespace fenestra::core
