#pragma once
// A Slicer volume property as stored in files, and its tabulation into the medium.

#include "model/medium/TransferFunction.h"

#include <optional>
#include <vector>

namespace fenestra {

/// A node of vtkPiecewiseFunction: midpoint and sharpness shape the curve toward the next node.
struct OpacityNode {
  double x = 0.0;
  double y = 0.0;
  double midpoint = 0.5;
  double sharpness = 0.0;
};

/// A node of vtkColorTransferFunction in its RGB colour space; display-encoded (sRGB) components.
struct ColorNode {
  double x = 0.0;
  Rgb color = Rgb::Zero();
  double midpoint = 0.5;
  double sharpness = 0.0;
};

struct VolumeProperty {
  std::vector<OpacityNode> scalarOpacity; ///< opacity per unit distance
  std::vector<OpacityNode>
      gradientOpacity; ///< over |gradient| in scalar units per mm; may be empty
  std::vector<ColorNode> color;
  double unitDistance = 1.0; ///< mm
  bool shade = false;
  double diffuse = 0.9, specular = 0.2, specularPower = 10.0;
  double anisotropy = 0.0; ///< Henyey-Greenstein g
};

/// vtkPiecewiseFunction's value at x (its GetTable: midpoint, sharpness, Hermite curve; clamped to
/// the end nodes outside).
double opacityAt(const std::vector<OpacityNode>& nodes, double x);
/// vtkColorTransferFunction's display-encoded value at x.
Rgb colorAt(const std::vector<ColorNode>& nodes, double x);
/// The sRGB electro-optical transfer function (IEC 61966-2-1), per component.
Rgb decodeSrgb(const Rgb& encoded);

/// Extinction -ln(1 - opacity) / unitDistance with opacity capped at 0.9999, decoded colour as
/// albedo; both piecewise linear with knots kept and a relative error of at most 1e-4.
/// Throws Error (input; `source` names the file) if a node list is empty or a number is unusable.
TransferFunction tabulate(const VolumeProperty& property, const std::string& source);

} // namespace fenestra
