#pragma once
// What the oracle renders: the product's plain data, and nothing that computes.

#include "model/camera/Background.h"
#include "model/camera/Camera.h"
#include "model/lights/Light.h"
#include "model/medium/TransferFunction.h"
#include "model/volume/Mask.h"
#include "model/volume/Volume.h"

#include <map>
#include <optional>
#include <variant>
#include <vector>

namespace fenestra::oracle {

/// What is removed keeps `ghost` of its extinction, and behind the surface all of it comes back
/// over `softness` mm.
struct Edge {
  double ghost = 0.0, softness = 0.0;
};

/// Removes the half-space that the normal points at; world mm.
struct PlaneClip {
  Vec3 point, normal; ///< the normal is a unit vector
  Edge edge = {};
};

/// A hole toward the focus, `margin` mm wider than it.
struct HoleDescription {
  enum class Shape { box, cylinder, sphere };
  Shape shape = Shape::box;
  double margin = 0.0;
};

/// Removes what is nearer to the eye than the focus (cutaway), than the clipping surface, or than
/// the bottom of a hole.
struct DepthClip {
  bool isCutaway = false;
  Mask focus;
  std::vector<double> columns, rows; ///< coordinates of the buffer's samples, mm, in order
  std::vector<Vec2> sites;           ///< control points, mm on the plane through the target
  std::vector<double> depths;        ///< of the control points, mm
  double smoothing = 0.5;            ///< p of the thin plate spline
  std::optional<HoleDescription> hole = {};
  /// Where it is not empty: the depths of samples that are not focus, as they are to be taken.
  std::vector<double> given = {};
  /// Cells between samples where the surface is the focus's own depth, by the number of their first
  /// sample; between two depths where all samples around are focus, mm, the offset included.
  struct Seam {
    double least = -infinity, greatest = infinity;
  };
  std::map<std::size_t, Seam> seams = {};
  double offset = 0.0; ///< mm that all of it lies farther from the eye
  Edge edge = {};

  bool hasSteps() const { return isCutaway || hole; }
};

using ClipDescription = std::variant<std::monostate, PlaneClip, DepthClip>;

/// Outside a focus the extinction is multiplied, and the albedo paled toward its luminance.
struct StyleDescription {
  Mask focus;
  double extinction = 1.0, saturation = 1.0;
};

struct OracleScene {
  const Volume& volume;
  const TransferFunction& transfer;
  std::vector<Light> lights = {};
  CameraPose pose = {};
  int width = 16, height = 16;
  ClipDescription clip = {};
  std::optional<Affine> crop = {}; ///< maps [-1, 1]^3 onto the part of the volume that is there
  Background background = {};      ///< no gradient
  std::uint64_t bounces = std::numeric_limits<std::uint64_t>::max();
  std::optional<StyleDescription> style = {};
};

} // namespace fenestra::oracle
