#pragma once
// --view auto: the direction that shows the focus best.

#include "session/ViewScore.h"

namespace fenestra {

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
ViewDirection automaticView(const ViewScorer& score);

} // namespace fenestra
