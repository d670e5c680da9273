#pragma once
// A Slicer volume property as stored in files, and its tabulation into the medium.

#include "base/Color.h"
#include "model/medium/TransferFunction.h"

#include <vector>

namespace fenestra {

/// A node of vtkPiecewiseFunction, or of vtkColorTransferFunction in its RGB colour space: midpoint
/// and sharpness shape the curve toward the next node.
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

/// Progress of the curve from one node's value (0) to the next node's (1) at the share u of the
/// way; monotonic. Like vtkPiecewiseFunction::GetTable and vtkColorTransferFunction::GetTable
/// (RGB): the midpoint bends u, sharpness compresses the result, and a Hermite curve with end
/// slopes (1 - sharpness) follows.
double evaluateCurve(double u, double midpoint, double sharpness);

/// Extinction -ln(1 - opacity) / unitDistance with opacity capped at 0.9999, decoded colour as
/// albedo; both piecewise linear with knots kept and a relative error of at most 1e-4.
/// Throws Error (input; `source` names the file) if a node list is empty or a number is unusable.
TransferFunction tabulate(const VolumeProperty& property, const std::string& source);

} // namespace fenestra
