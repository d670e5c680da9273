#pragma once
// --view auto: the direction that shows the focus best.

#include "session/ViewScore.h"

namespace fenestra {

/// Where a viewer stands, and what is up to them; unit vectors, RAS.
struct ViewDirection {
  Vec3 fromTarget, up;
};

/// The direction that scores best, in two steps: 256 all around, and from the best of them to the
/// top of a quadratic through the scores within 25 degrees of it. Either takes a direction with
/// those near it, weighted by a Gaussian: a view is no better than what it becomes when it is
/// turned a little, and a focus that differs slightly is seen from slightly elsewhere, but where
/// views far apart are equally good. Threads change nothing.
///
/// Superior is up, or anterior where that is within 15 degrees of the view's axis. A focus that
/// rays hardly meet is looked at from anterior.
ViewDirection automaticView(const ViewScorer& score);

} // namespace fenestra
