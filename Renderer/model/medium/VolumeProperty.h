#pragma once
// A Slicer volume property as stored in files, and its tabulation as piecewise linear extinction
// and albedo. The table defines the medium: the original curves are not used after this point.

#include "base/Color.h"
#include "model/medium/TransferFunction.h"

#include <vector>

namespace fenestra::core {

/// A node of vtkPiecewiseFunction, or of vtkColorTransferFunction in RGB: midpoint and sharpness
/// shape the curve toward the next node.
template <typename Value>
struct CurveNode {
  double x = 0.0;
  Value value = {};
  double midpoint = 0.5;
  double sharpness = 0.0;
};
using OpacityNode = CurveNode<double>;
using ColorNode = CurveNode<Rgb>; ///< display-encoded (sRGB) components

struct VolumeProperty {
  std::vector<OpacityNode> scalarOpacity; ///< opacity per unit distance
  /// Over |gradient| in scalar units per mm; may be empty.
  std::vector<OpacityNode> gradientOpacity;
  std::vector<ColorNode> color;
  double unitDistance = 1.0; ///< mm
  bool shade = false;
  double diffuse = 0.9, specular = 0.2, specularPower = 10.0;
  double anisotropy = 0.0; ///< Henyey-Greenstein g
};

/// Progress of the curve from one node's value (0) to the next node's (1), at the fraction u of the
/// distance; monotonic. As in vtkPiecewiseFunction::GetTable and vtkColorTransferFunction::GetTable
/// (RGB): the midpoint warps u, sharpness compresses the result, and a Hermite curve with end
/// slopes (1 - sharpness) follows.
double evaluateCurve(double u, double midpoint, double sharpness);

/// Extinction is -ln(1 - opacity) / unitDistance with opacity capped at 0.9999; the albedo is the
/// decoded color. Both are piecewise linear, keep the nodes as knots, and have a relative error of
/// at most 1e-4. Throws Error (input) for an empty node list or an invalid number; `source`: file.
TransferFunction tabulate(const VolumeProperty& property, const std::string& source);

} // namespace fenestra::core
