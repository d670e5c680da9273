#pragma once
// Automatic view direction (--view auto). The score of a direction d, from focus to camera, is
//     area(d) * (1 - removed(d)) * preference(d)
// - area: projected area of the focus along d, mm².
// - removed: fraction of the visible context that a clipping surface would remove: all context in
//   front of the focus and, beside it, the context nearer than the mean depth of the focus.
//   Context counts by its opacity under the transfer function, so air does not count.
// - preference: 1 + 0.05 (d . anterior) - 0.1 (d . superior)², which favors upright anterior views
//   if scores are nearly equal.
// Rays are parallel. The score depends only on volume, focus and transfer function, so the view
// does not change with the projection, the clip or the image size. Scores are averaged over
// neighboring directions, so that a small change of the focus hardly changes the view.

#include "clip/focus/FocusCells.h"
#include "model/medium/TransferFunction.h"
#include "model/volume/Domain.h"
#include "model/volume/Volume.h"

namespace fenestra::core {

struct ViewScore {
  double area = 0.0;            ///< projected area of the focus, mm²
  double removedFraction = 0.0; ///< fraction of the context, 0 to 1
  double score = 0.0;           ///< mm²
  double hitFraction = 0.0;     ///< fraction of the rays that hit the focus
};

class ViewScorer {
public:
  ViewScorer(const Volume& volume, const Domain& domain, const TransferFunction& transfer,
             const Mask& focus);

  /// `fromTarget`: unit vector. `rays`: number of rays over the bounding box of the focus. The
  /// relative error of the score is about 1 / number of rays that hit the focus.
  ViewScore operator()(const Vec3& fromTarget, std::size_t rays) const;

private:
  /// One coarse cell of the volume that contains visible context.
  struct ContextCell {
    Vec3 center;   ///< world mm
    double weight; ///< opacity of the cell, 0 to 1
  };
  class FocusDepths;

  double removedFraction(const FocusDepths& focus) const;

  Domain m_domain;
  FocusCells m_focus;
  std::vector<ContextCell> m_context;
  double m_cellEdge = 1.0; ///< edge of a coarse cell, mm
};

/// Unit vectors in RAS: direction from the target to the camera, and the camera's up direction.
struct ViewDirection {
  Vec3 fromTarget, up;
};

/// Returns the direction with the best score. The search takes the best of 256 directions on the
/// sphere, then the maximum of a quadratic fitted to the scores within 25 degrees of it. Both steps
/// weight neighboring directions by a Gaussian, so a slightly different focus gives a slightly
/// different view, unless distant views score equally. The result does not depend on the number of
/// threads.
///
/// Up is superior, or anterior if the view axis is within 15 degrees of superior. The direction is
/// anterior if almost no ray hits the focus.
ViewDirection findBestView(const ViewScorer& scorer);

} // namespace fenestra::core
