#pragma once
// Input of the oracle: Fenestra's data types, but none of its algorithms.

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

namespace fenestra::core::oracle {

/// Edge of a clip: removed parts keep the factor `ghost` on their extinction. Behind the surface
/// the full extinction returns over `softness` mm.
struct Edge {
  double ghost = 0.0, softness = 0.0;
};

/// Removes the half-space that the normal points into; world mm.
struct PlaneClip {
  Vec3 point, normal; ///< the normal is a unit vector
  Edge edge = {};
};

/// Hole toward the focus, `margin` mm wider than the focus.
struct HoleDescription {
  enum class Shape { box, cylinder, sphere };
  Shape shape = Shape::box;
  double margin = 0.0;
};

/// Removes everything nearer to the camera than the focus (cutaway), than the clipping surface, or
/// than the bottom of a hole.
struct DepthClip {
  bool isCutaway = false;
  Mask focus;
  std::vector<double> columns, rows; ///< coordinates of the buffer's samples, mm, in order
  std::vector<Vec2> sites;           ///< control points, mm on the plane through the target
  std::vector<double> depths;        ///< of the control points, mm
  double smoothing = 0.5;            ///< p of the thin plate spline
  std::optional<HoleDescription> hole = {};
  /// Depths, mm, of the samples outside the focus; empty: computed.
  std::vector<double> givenDepths = {};
  /// Silhouette cell: its surface is the depth of the focus itself, not interpolated. Keyed by its
  /// first sample. If all samples around it are focus, `min` and `max` bound that depth, mm, offset
  /// included.
  struct SilhouetteCell {
    double min = -infinity, max = infinity;
  };
  std::map<std::size_t, SilhouetteCell> silhouettes = {};
  double offset = 0.0; ///< shift of the surface away from the camera, mm
  Edge edge = {};

  bool hasSteps() const { return isCutaway || hole; }
};

using ClipDescription = std::variant<std::monostate, PlaneClip, DepthClip>;

/// Style of the context: its extinction is multiplied, its albedo blended toward its luminance.
struct StyleDescription {
  Mask focus;
  double extinction = 1.0, saturation = 1.0;
};

/// Components of the medium: number 0 for everything outside segments, and those of the segments,
/// whose masks lie on voxels of one label map.
struct ComponentsDescription {
  struct Segment {
    Mask mask;
    int priority;          ///< where segments overlap, the higher one wins
    std::size_t component; ///< 0: outside segments
  };
  struct Component {
    TransferFunction transfer; ///< has surface shading if the volume's own has
    bool isClipped = true;     ///< false: the clip does not affect it
    /// Weight of the label weight's gradient, per mm, next to the scalar's in spans per mm.
    double interfaceWeight = 0.0;
  };
  std::vector<Segment> segments;
  std::vector<Component> components;
  /// True: components differ in albedo alone, and a point has their mean albedo. False: a collision
  /// samples one component.
  bool isTint = false;
};

struct OracleScene {
  const Volume& volume;
  const TransferFunction& transfer;
  std::vector<Light> lights = {};
  CameraPose pose = {};
  int width = 16, height = 16;
  ClipDescription clip = {};
  std::optional<Affine> crop = {}; ///< maps [-1, 1]^3 to the part that remains; empty: no crop
  Background background = {};      ///< any kind except a gradient
  std::uint64_t bounces = std::numeric_limits<std::uint64_t>::max();
  std::optional<StyleDescription> style = {};
  std::optional<ComponentsDescription> components = {};
};

} // namespace fenestra::core::oracle
