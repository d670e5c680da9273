#pragma once
// Input of the oracle: the product's plain data, without code that computes.

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

/// Edge of a clip: removed matter keeps `ghost` of its extinction; behind the surface the full
/// extinction returns over `softness` mm.
struct Edge {
  double ghost = 0.0, softness = 0.0;
};

/// Removes the half-space into which the normal points; world mm.
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

/// Removes everything nearer to the eye than the focus (cutaway), the clipping surface, or the
/// bottom of a hole.
struct DepthClip {
  bool isCutaway = false;
  Mask focus;
  std::vector<double> columns, rows; ///< coordinates of the buffer's samples, mm, in order
  std::vector<Vec2> sites;           ///< control points, mm on the plane through the target
  std::vector<double> depths;        ///< of the control points, mm
  double smoothing = 0.5;            ///< p of the thin plate spline
  std::optional<HoleDescription> hole = {};
  /// Depths, mm, of the samples that are not focus; empty: computed.
  std::vector<double> givenDepths = {};
  /// Cell between samples in which the surface is the focus's own depth, keyed by its first sample.
  /// `least`, `greatest`: range of that depth if all samples around are focus, mm, offset included.
  struct SilhouetteCell {
    double min = -infinity, max = infinity;
  };
  std::map<std::size_t, SilhouetteCell> silhouettes = {};
  double offset = 0.0; ///< shift of the surface away from the eye, mm
  Edge edge = {};

  bool hasSteps() const { return isCutaway || hole; }
};

using ClipDescription = std::variant<std::monostate, PlaneClip, DepthClip>;

/// Style of the context: its extinction is multiplied, its albedo blended toward its luminance.
struct StyleDescription {
  Mask focus;
  double extinction = 1.0, saturation = 1.0;
};

/// Components of the medium: one of what is in no segment, and those of the segments, whose labels
/// lie on voxels of one labelmap.
struct ComponentsDescription {
  struct Segment {
    Mask mask;
    int priority;          ///< where segments overlap, the greater takes what it covers
    std::size_t component; ///< 0: what is in no segment
  };
  struct Component {
    TransferFunction transfer; ///< with surfaces where the volume's own has them
    bool isClipped = true;     ///< false: the clip leaves it
    /// Weight of its share's gradient, per mm, beside the scalar's in spans per mm.
    double interfaceWeight = 0.0;
  };
  std::vector<Segment> segments;
  std::vector<Component> components;
  /// True: only albedo differs between components, and a point has the mean of it. False: a
  /// collision meets one component.
  bool isTint = false;
};

struct OracleScene {
  const Volume& volume;
  const TransferFunction& transfer;
  std::vector<Light> lights = {};
  CameraPose pose = {};
  int width = 16, height = 16;
  ClipDescription clip = {};
  std::optional<Affine> crop = {}; ///< maps [-1, 1]^3 onto the part kept; empty: all is kept
  Background background = {};      ///< any but a gradient
  std::uint64_t bounces = std::numeric_limits<std::uint64_t>::max();
  std::optional<StyleDescription> style = {};
  std::optional<ComponentsDescription> components = {};
};

} // namespace fenestra::oracle
