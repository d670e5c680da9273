#pragma once
// First pass of the method: from a view and a focus to the clip that shows the focus.

#include "base/Distribution.h"
#include "clip/field/Clip.h"
#include "clip/focus/Contour.h"
#include "clip/focus/FocusDepth.h"
#include "clip/surface/Hole.h"

#include <optional>
#include <string>
#include <vector>

namespace fenestra {

enum class SurfaceMode {
  cutaway, ///< removes only the matter in front of the focus
  surface, ///< the volumetric clipping surface: the cut continues into the focus's surroundings
  hole,    ///< a channel from the eye to the focus
};

/// Continuation of a surface from the focus into its surroundings.
enum class Boundary {
  spline, ///< the paper's: a thin plate spline through some control points
  exact,  ///< from every point of the focus's boundary, with the focus's slope (SmoothFill.h)
};

struct SurfaceOptions {
  SurfaceMode mode = SurfaceMode::surface;
  int controlPoints = 50; ///< number on the focus's contours, 1 to 1000
  double smoothing = 0.5; ///< p of the thin plate spline, 0 to 1
  Boundary boundary = Boundary::spline;
  HoleOptions hole = {};
  double offset = 0.0; ///< mm, shift of the surface away from the eye; negative: toward the eye
  ClipEdge edge = {};

  bool operator==(const SurfaceOptions&) const = default;
};

struct ClippingSurface {
  Clip clip;                                 ///< a ClipDepth
  FocusDepth focus;                          ///< over the samples of the clip's buffer
  std::vector<ControlPoint> controlPoints{}; ///< spline only, else empty
  /// |f(x) - z|, mm, of a spline f over the focus samples (x, depth z) on the contours.
  std::optional<Distribution> mismatch{};
  double focusSeconds = 0.0, splineSeconds = 0.0, fillSeconds = 0.0;
  std::vector<std::string> warnings{};
};

/// Throws Error (input) where no sample meets the focus.
void requireVisible(const FocusDepth& focus, const Mask& mask);

/// Least-squares plane, in depth, through the visible points of the focus, never seen edge-on. The
/// normal points towards the eye. Needs at least one focus sample; with too few samples to
/// determine a tilt the plane faces the eye.
ClipPlane fitFocusPlane(const Camera& camera, const FocusDepth& focus);

/// Throws Error (usage) for options out of range and Error (input) where no ray meets the focus.
ClippingSurface buildClippingSurface(const Camera& camera, const Domain& volume, const Mask& focus,
                                     const SurfaceOptions& options);

} // namespace fenestra
