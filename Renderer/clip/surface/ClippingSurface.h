#pragma once
// The first pass of the method: from a view and a focus to the clip that shows it.

#include "base/Distribution.h"
#include "clip/focus/Contour.h"
#include "clip/focus/FocusDepth.h"
#include "clip/keep/Clip.h"
#include "clip/surface/Hole.h"

#include <optional>
#include <string>
#include <vector>

namespace fenestra {

enum class SurfaceMode {
  cutaway, ///< removes what is in front of the focus only
  surface, ///< the volumetric clipping surface: the cut continues into the focus's surroundings
  hole,    ///< a channel from the eye to the focus
};

/// How a surface continues from the focus into its surroundings.
enum class Boundary {
  spline, ///< the paper's: a thin plate spline through some control points
  exact,  ///< from every point of the focus's boundary, with the focus's slope (SmoothFill.h)
};

struct SurfaceOptions {
  SurfaceMode mode = SurfaceMode::surface;
  int controlPoints = 50; ///< on the focus's contours, 1 to 1000
  double smoothing = 0.5; ///< p of the thin plate spline, 0 to 1
  Boundary boundary = Boundary::spline;
  HoleOptions hole = {};
  double offset = 0.0; ///< mm that the surface is moved away from the eye, or toward it (negative)
  ClipEdge edge = {};

  bool operator==(const SurfaceOptions&) const = default;
};

/// Of a spline f, |f(x) - z| in mm over the focus samples on the contours: how far it misses their
/// depth.
using BoundaryMismatch = Distribution;

struct ClippingSurface {
  Clip clip;                                  ///< a ClipDepth
  FocusDepth focus;                           ///< over the samples of the clip's buffer
  std::vector<ControlPoint> controlPoints{};  ///< of a spline only
  std::optional<BoundaryMismatch> mismatch{}; ///< of a spline only
  double focusSeconds = 0.0, splineSeconds = 0.0, fillSeconds = 0.0;
  std::vector<std::string> warnings{};
};

/// Throws Error (input) where no sample meets the focus.
void requireVisible(const FocusDepth& focus, const Mask& mask);

/// Throws Error (usage) for options out of range and Error (input) where no ray meets the focus.
ClippingSurface buildClippingSurface(const Camera& camera, const Domain& volume, const Mask& focus,
                                     const SurfaceOptions& options);

} // namespace fenestra
