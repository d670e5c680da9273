#pragma once
// First pass of the method, once per view: builds the clip that shows the focus.

#include "base/Distribution.h"
#include "base/Error.h"
#include "clip/field/Clip.h"
#include "clip/focus/Contour.h"
#include "clip/focus/FocusDepth.h"
#include "clip/surface/Hole.h"

#include <optional>
#include <string>
#include <vector>

namespace fenestra::core {

enum class SurfaceMode {
  cutaway, ///< removes only what is in front of the focus
  surface, ///< the volumetric clipping surface: the cut continues from the focus into the context
  hole,    ///< a channel from the camera to the focus
};

/// How the surface continues from the focus into the context.
enum class Boundary {
  spline, ///< as in the paper (CITATION.cff): a thin plate spline, fitted to control points
  exact,  ///< from all boundary points of the focus, with the slope of the focus
          ///< (clip/portable/SmoothFill.h)
};

struct SurfaceOptions {
  SurfaceMode mode = SurfaceMode::surface;
  int controlPoints = 50; ///< on the contours of the focus, 1 to 1000
  double smoothing = 0.5; ///< p of the thin plate spline, 0 to 1
  Boundary boundary = Boundary::spline;
  HoleOptions hole = {};
  double offset = 0.0; ///< mm, moves the surface away from the camera; negative: toward it
  ClipEdge edge = {};

  bool operator==(const SurfaceOptions&) const = default;
};

struct ClippingSurface {
  Clip clip;        ///< a ClipDepth
  FocusDepth focus; ///< over the samples of the clip's buffer
  FocusDepth shown; ///< the focus without slots (SilhouetteCells.h), which the clip follows
  std::vector<ControlPoint> controlPoints{}; ///< empty unless the boundary is a spline
  /// Spline f only: |f(x) - z|, mm, at the focus samples on the contours, at x with depth z.
  std::optional<Distribution> mismatch{};
  double focusSeconds = 0.0, splineSeconds = 0.0, fillSeconds = 0.0;
  std::vector<Message> warnings{};
};

/// Throws Error (input) if no sample is focus.
void requireVisible(const FocusDepth& focus, const Mask& mask);

/// Fits a plane to the visible points of the focus by least squares in depth, so that it is never
/// seen edge-on. Its normal points toward the camera. Needs at least one focus sample. If the
/// samples do not determine a tilt, the plane faces the camera.
ClipPlane fitFocusPlane(const Camera& camera, const FocusDepth& focus);

/// Throws Error (request) for options out of range, and Error (input) if no ray hits the focus.
ClippingSurface buildClippingSurface(const Camera& camera, const Domain& volume, const Mask& focus,
                                     const SurfaceOptions& options);

} // namespace fenestra::core
