#pragma once
// How well a focus is seen from a direction: what --view auto chooses by. A direction d, from the
// focus to the eye, scores
//     area(d) * (1 - removed(d)) * custom(d).
// - area: of the focus's projection along d, mm². That is the surface of it that the eye meets
//   times the mean cosine between that surface and d: it counts to see more of the focus, and to
//   see it less foreshortened.
// - removed: the share of the context that a clipping surface takes away: in front of the focus all
//   that hides it; beside it what is nearer than its mean depth, where a surface levels off.
//   Context is what the transfer function shows and is not focus: air costs nothing.
// - custom: 1 + 0.05 (d . anterior) - 0.1 (d . superior)²: of views that are nearly as good, the
//   one that people are used to, in which up is up.
// Eye rays are parallel: a direction scores the same for both projections, and for any size of
// picture.

#include "clip/focus/FocusCells.h"
#include "model/medium/TransferFunction.h"
#include "model/volume/Domain.h"
#include "model/volume/Volume.h"

namespace fenestra {

struct ViewScore {
  double area = 0.0;    ///< of the focus's projection, mm²
  double removed = 0.0; ///< share of the context, 0 to 1
  double score = 0.0;   ///< mm²
  double met = 0.0;     ///< share of the rays that found the focus
};

class ViewScorer {
public:
  ViewScorer(const Volume& volume, const Domain& domain, const TransferFunction& transfer,
             const Mask& focus);

  /// `fromTarget`: a unit vector; `rays`: how many look for the focus, over the box that it fills.
  /// The score is right to about one over how many find it.
  ViewScore operator()(const Vec3& fromTarget, std::size_t rays) const;

private:
  /// About as much of the context as a coarse cell of the volume holds.
  struct Matter {
    Vec3 center;   ///< world mm
    double weight; ///< its opacity, 0 to 1
  };
  class FocusDepths;

  void gatherContext(const Volume& volume, const TransferFunction& transfer, const Mask& focus);
  double removedShare(const FocusDepths& focus) const;

  Domain m_domain;
  FocusCells m_focus;
  std::vector<Matter> m_context;
  double m_matterEdge = 1.0; ///< mm
};

} // namespace fenestra
