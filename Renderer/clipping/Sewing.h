#pragma once
// Where the exact surface meets the focus, between the samples.

#include "clipping/FocusDepth.h"

namespace fenestra {

/// Refines the cells of a filled buffer that are seams. A square with any of the focus at its
/// corners has the greatest of their depths, so that the focus hides nothing of itself and the
/// surface nothing of the focus; beside it the focus's depth and fall go on, and go over into the
/// context's samples, which they meet where other cells begin.
void sew(DepthBuffer& buffer, const FocusDepth& focus, const std::vector<Seam>& seams);

} // namespace fenestra
