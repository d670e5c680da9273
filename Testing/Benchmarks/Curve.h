#pragma once
// Error over time: renders of one scene in one mode at growing sample counts.

#include "Modes.h"
#include "References.h"

#include <optional>
#include <vector>

namespace fenestra::benchmarks {

struct CurveSettings {
  double budget = 60.0;        ///< CPU seconds of one curve, all seeds together
  std::uint64_t samples = 4;   ///< samples a pixel of the first point; doubled from point to point
  int seeds = 3;               ///< renders a point, at most; fewer if the budget ends
  double leastRelMse = 2.5e-4; ///< end of a curve: the first point below this relMSE
};

/// Renders of one sample count.
struct Point {
  std::uint64_t samples = 0; ///< a pixel
  int seeds = 0;
  double cpuSeconds = 0.0; ///< user + system, of one render
  double relMse = 0.0;     ///< mean over seeds, less the reference's own variance
  double spread = 0.0;     ///< standard deviation of relMSE over seeds; 0 for one seed
  double bias = 0.0;       ///< of the image mean, relative to the reference's mean
  double biasError = 0.0;  ///< standard error of `bias`, the reference's own included

  double efficiency() const { return 1.0 / (relMse * cpuSeconds); }
};

/// Measures a mode's curve. `settings`: the scene's; their samples and seed are ignored.
std::vector<Point> measureCurve(const Mode& mode, const PreparedScene& scene,
                                const RenderSettings& settings, const Image& reference,
                                const CurveSettings& limits);

/// Efficiency 1 / (relMSE * CPU seconds) near a relMSE: interpolated linearly in logarithms where
/// the curve crosses that relMSE, else taken from the nearest point. Empty without a positive
/// relMSE.
struct Efficiency {
  double value, relMse;
};
std::optional<Efficiency> efficiencyNear(const std::vector<Point>& curve, double relMse);

} // namespace fenestra::benchmarks
