#pragma once
// Error over time: renders of one scene in one mode with increasing sample counts.

#include "Modes.h"
#include "References.h"

#include <optional>
#include <vector>

namespace fenestra::core::benchmarks {

struct CurveSettings {
  double budget = 60.0;        ///< CPU seconds per curve, over all seeds
  std::uint64_t samples = 4;   ///< samples per pixel of the first point; doubled for each next one
  int seeds = 3;               ///< maximum renders per point; fewer if the budget ends
  double leastRelMse = 2.5e-4; ///< a curve ends at the first point below this relMSE
};

/// Renders with one sample count.
struct Point {
  std::uint64_t samples = 0; ///< per pixel
  int seeds = 0;
  double cpuSeconds = 0.0; ///< user + system, per render
  double relMse = 0.0;     ///< mean over seeds, minus the variance of the reference
  double spread = 0.0;     ///< standard deviation of relMSE over seeds; 0 for one seed
  double bias = 0.0;       ///< of the image mean, relative to the reference's mean
  double biasError = 0.0;  ///< standard error of `bias`, including the reference's

  double efficiency() const { return 1.0 / (relMse * cpuSeconds); }
};

/// Measures the curve of a mode. `settings`: of the scene; samples and seed are ignored.
std::vector<Point> measureCurve(const Mode& mode, const PreparedScene& scene,
                                const RenderSettings& settings, const Image& reference,
                                const CurveSettings& limits);

/// Efficiency 1 / (relMSE * CPU seconds) near a relMSE. It is interpolated linearly in logarithms
/// where the curve crosses that relMSE, else taken from the nearest point. Empty without a positive
/// relMSE.
struct Efficiency {
  double value, relMse;
};
std::optional<Efficiency> findEfficiency(const std::vector<Point>& curve, double relMse);

} // namespace fenestra::core::benchmarks
