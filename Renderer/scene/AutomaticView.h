#pragma once
// --view auto: the direction that shows the focus best. A direction d, from the focus to the eye,
// scores
//     area(d) * (1 - removed(d)) * custom(d).
// - area: of the focus's projection along d, mm²: visible surface of the focus times the mean of
//   cos(normal, d). More visible focus, and less foreshortening, score higher.
// - removed: share of the context that a clipping surface takes away: in front of the focus all
//   hiding context; beside the focus all context nearer than the focus's mean depth, where a
//   surface levels off. Context is visible under the transfer function: air costs nothing.
// - custom: 1 + 0.05 (d . anterior) - 0.1 (d . superior)²: among nearly equal views, preference for
//   the customary one, in which up is up.
// Eye rays are parallel: scores are independent of the projection and of the picture's size.

#include "clip/focus/FocusCells.h"
#include "model/medium/TransferFunction.h"
#include "model/volume/Domain.h"
#include "model/volume/Volume.h"

namespace fenestra {

struct ViewScore {
  double area = 0.0;            ///< of the focus's projection, mm²
  double removedFraction = 0.0; ///< share of the context, 0 to 1
  double score = 0.0;           ///< mm²
  double hitFraction = 0.0;     ///< share of the rays that meet the focus
};

class ViewScorer {
public:
  ViewScorer(const Volume& volume, const Domain& domain, const TransferFunction& transfer,
             const Mask& focus);

  /// `fromTarget`: unit vector. `rays`: number of rays, over the box of the focus. Relative error
  /// of the score: about 1 / number of rays that meet the focus.
  ViewScore operator()(const Vec3& fromTarget, std::size_t rays) const;

private:
  /// Context in one coarse cell of the volume.
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

/// Direction from the target to the viewer, and the viewer's up; unit vectors, RAS.
struct ViewDirection {
  Vec3 fromTarget, up;
};

/// Direction of the best score, in two steps: the best of 256 all around, then the top of a
/// quadratic through the scores within 25 degrees of that best. Both steps weight neighbouring
/// directions by a Gaussian: a view is no better than after a small turn, and a slightly different
/// focus gives a slightly different view, unless views far apart are equally good. Independent of
/// threads.
///
/// Up is superior, or anterior if superior is within 15 degrees of the view's axis. A focus that
/// rays hardly meet is viewed from anterior.
ViewDirection findBestView(const ViewScorer& scorer);

} // namespace fenestra
