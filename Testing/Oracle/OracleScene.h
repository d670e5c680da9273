#pragma once
// What the oracle renders: the product's plain data, and nothing that computes.

#include "camera/Camera.h"
#include "lights/Light.h"
#include "medium/TransferFunction.h"
#include "transport/Background.h"
#include "volume/Mask.h"
#include "volume/Volume.h"

#include <optional>
#include <variant>
#include <vector>

namespace fenestra::oracle {

/// Removes the half-space that the normal points at; world mm.
struct PlaneClip {
  Vec3 point, normal;
};

/// Removes what is nearer to the eye than the focus (cutaway), or than the clipping surface.
struct DepthClip {
  bool isCutaway = false;
  Mask focus;
  std::vector<double> columns, rows; ///< coordinates of the buffer's samples, mm, in order
  std::vector<Vec2> sites;           ///< control points, mm on the plane through the target
  std::vector<double> depths;        ///< of the control points, mm
  double smoothing = 0.5;            ///< p of the thin plate spline
};

using ClipDescription = std::variant<std::monostate, PlaneClip, DepthClip>;

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
};

} // namespace fenestra::oracle
