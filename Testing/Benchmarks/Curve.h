#pragma once
// Error over time: a mode's renders of one scene at growing sample counts.

#include "Modes.h"
#include "References.h"

#include <optional>
#include <vector>

namespace fenestra::benchmarks {

struct CurveSettings {
  double budget = 60.0;        ///< CPU seconds of one curve, all seeds together
  std::uint64_t samples = 4;   ///< a pixel, of the first point; each further one has twice as many
  int seeds = 3;               ///< renders of a point, as many as the budget allows
  double leastRelMse = 2.5e-4; ///< a curve ends with the first point below it
};

/// Renders of one sample count.
struct Point {
  std::uint64_t samples = 0; ///< a pixel
  int seeds = 0;
  double cpuSeconds = 0.0; ///< user and system, of one render
  double relMse = 0.0;     ///< less the reference's own variance; mean over seeds
  double spread = 0.0;     ///< of relMse: standard deviation over seeds; 0 of one
  double bias = 0.0;       ///< of the image mean, relative to the reference's
  double biasError = 0.0;  ///< one standard error of it, the reference's own included

  double efficiency() const { return 1.0 / (relMse * cpuSeconds); }
};

/// `settings` are the scene's; its samples and seed do not count.
std::vector<Point> measureCurve(const Mode& mode, const Scene& scene,
                                const RenderSettings& settings, const Image& reference,
                                const CurveSettings& wanted);

/// 1 / (relMSE * CPU seconds) near a relMSE: where the curve passes it, at the time that a straight
/// line between its two neighbours has there in logarithms; else at the point nearest to it.
/// Nothing for a curve without a positive relMSE.
struct Efficiency {
  double value, relMse;
};
std::optional<Efficiency> efficiencyNear(const std::vector<Point>& curve, double relMse);

} // namespace fenestra::benchmarks
