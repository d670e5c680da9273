#pragma once
// Gain of a clip for the focus, and its cost for the context.

#include "transport/render/Render.h"

namespace fenestra {

/// Points of the focus that the eye meets at the pixels' centres.
class FocusPoints {
public:
  /// `depth`: mm in view space, row by row from the top; infinity where the focus is missed.
  FocusPoints(const RenderScene& scene, const std::vector<double>& depth);

  struct Point {
    Ray ray;         ///< of the eye
    double distance; ///< mm along it
    bool isKept;     ///< clipping leaves it, to the depth that the focus has within a pixel
    std::size_t pixel;

    Vec3 position() const { return ray.at(distance); }
  };
  const std::vector<Point>& points() const { return m_points; }
  /// Share of them that clipping leaves.
  double kept() const;

private:
  std::vector<Point> m_points;
};

/// Mean over the focus's points of the transmittance to them from where the eye ray starts: the
/// share of the focus's pixels shown unoccluded. What clipping removes counts as not shown.
/// Once `stop` is true walks end where they are, and what is returned means nothing, here and
/// below.
double focusCoverage(const RenderScene& scene, const FocusPoints& focus, std::uint64_t seed,
                     const StopFlag& stop = neverStopped);

/// Light that comes to the points that clipping leaves straight from the lights, relative to what
/// comes to them in `alone`, the same scene of nothing but the focus. Some thousand points and
/// lights, the same for both; nothing where none comes in `alone`.
std::optional<double> focusLight(const RenderScene& scene, const RenderScene& alone,
                                 const FocusPoints& focus, std::uint64_t seed,
                                 const StopFlag& stop = neverStopped);

/// The share that clipping removes of the volume's matter (extinction above 0) that is not focus,
/// from a quarter of a million points: to about 0.001. Nothing where they meet no such matter.
std::optional<double> contextRemoved(const RenderScene& scene, const Mask& focus,
                                     std::uint64_t seed);

} // namespace fenestra
