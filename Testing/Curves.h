#pragma once
// Value of a volume property's curve at a point, as in vtkPiecewiseFunction and
// vtkColorTransferFunction: clamped to the end nodes outside.

#include "model/medium/VolumeProperty.h"

namespace fenestra::core {

template <typename Value>
Value interpolateCurve(const std::vector<CurveNode<Value>>& nodes, double x) {
  const auto next = std::ranges::upper_bound(nodes, x, {}, &CurveNode<Value>::x);
  if (next == nodes.begin() || next == nodes.end())
    return next == nodes.begin() ? nodes.front().value : nodes.back().value;
  const CurveNode<Value>& before = *(next - 1);
  const double u = std::clamp((x - before.x) / (next->x - before.x), 0.0, 1.0);
  return before.value +
         (next->value - before.value) * evaluateCurve(u, before.midpoint, before.sharpness);
}

} // namespace fenestra::core
