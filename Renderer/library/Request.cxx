// From the public options of a scene to the renderer's request.

#include "library/Convert.h"
#include "library/Data.h"

#include <algorithm>

namespace fenestra {
inline namespace v1 {
namespace {

void requireRange(const char* what, double value, double least, double greatest) {
  if (!(value >= least && value <= greatest)) // NaN is outside
    throw core::requestError(core::ErrorCode::invalidValue, what, "is ", core::toString(value),
                             ", but must be from ", core::toString(least), " to ",
                             core::toString(greatest));
}

void requireRange(const char* what, const std::optional<double>& value, double least,
                  double greatest) {
  if (value)
    requireRange(what, *value, least, greatest);
}

void requireFinite(const char* what, const Vector3& v) {
  if (!std::ranges::all_of(v, [](double x) { return std::isfinite(x); }))
    throw core::requestError(core::ErrorCode::invalidValue, what, "is not finite");
}

std::optional<core::Vec3> toVec3(const char* what, const std::optional<Vector3>& v) {
  if (!v)
    return std::nullopt;
  requireFinite(what, *v);
  return v1::toVec3(*v);
}

core::ViewRequest makeView(const View& view) {
  requireRange("scale", view.scale, 1e-9, 1e9);
  requireRange("angle", view.angle, 1e-6, 179.0);
  core::ViewRequest request{.name = view.name,
                            .position = toVec3("position", view.position),
                            .target = toVec3("target", view.target),
                            .up = toVec3("up", view.up),
                            .scale = view.scale,
                            .angle = view.angle};
  if (view.name && view.position)
    throw core::requestError(core::ErrorCode::invalidValue, "view",
                             "has a name and a position, which contradict each other");
  if (view.projection)
    request.projection = *view.projection == Projection::perspective
                             ? core::Projection::perspective
                             : core::Projection::orthographic;
  return request;
}

std::optional<core::ClipMode> toMode(ClipMode mode) {
  switch (mode) {
  case ClipMode::automatic:
    break;
  case ClipMode::none:
    return core::ClipMode::none;
  case ClipMode::plane:
    return core::ClipMode::plane;
  case ClipMode::cutaway:
    return core::ClipMode::cutaway;
  case ClipMode::surface:
    return core::ClipMode::surface;
  case ClipMode::hole:
    return core::ClipMode::hole;
  case ClipMode::ghost:
    return core::ClipMode::ghost;
  }
  return std::nullopt;
}

core::HoleShape toShape(HoleShape shape) {
  switch (shape) {
  case HoleShape::box:
    return core::HoleShape::box;
  case HoleShape::sphere:
    return core::HoleShape::sphere;
  case HoleShape::cylinder:
    break;
  }
  return core::HoleShape::cylinder;
}

core::ClipRequest makeClip(const Clip& clip, bool hasFocus) {
  constexpr double longest = 1e6; // mm
  requireRange("control points", clip.controlPoints, 3.0, 1000.0);
  requireRange("spline smoothing", clip.splineSmoothing, 0.0, 1.0);
  requireRange("hole margin", clip.holeMargin, 0.0, longest);
  requireRange("ghost", clip.ghost, 0.0, 1.0);
  requireRange("clip offset", clip.offset, -longest, longest);
  requireRange("clip softness", clip.softness, 0.0, longest);
  core::ClipRequest request{
      .mode = toMode(clip.mode), .ghost = clip.ghost, .softness = clip.softness};
  core::SurfaceOptions& surface = request.surface;
  surface.boundary =
      clip.boundary == ClipBoundary::exact ? core::Boundary::exact : core::Boundary::spline;
  surface.controlPoints = clip.controlPoints;
  surface.smoothing = clip.splineSmoothing;
  surface.hole = {toShape(clip.hole), clip.holeMargin};
  surface.offset = clip.offset;
  if (clip.plane) {
    requireFinite("origin of the plane", clip.plane->origin);
    requireFinite("normal of the plane", clip.plane->normal);
    const core::Vec3 normal = v1::toVec3(clip.plane->normal);
    if (normal.isZero(0.0))
      throw core::requestError(core::ErrorCode::invalidValue, "normal of the plane", "is zero");
    request.plane = {v1::toVec3(clip.plane->origin), normal.stableNormalized()};
  }
  const core::ClipMode mode = request.resolveMode(hasFocus);
  if (!hasFocus && (core::isDepthClip(mode) || (mode == core::ClipMode::plane && !clip.plane)))
    throw core::requestError(core::ErrorCode::focusRequired, "clip", "requires a focus");
  return request;
}

void setAppearance(const Appearance& appearance, core::RenderRequest& request) {
  requireRange("transfer shift", appearance.transferShift, -1e30, 1e30);
  requireRange("density", appearance.density, 0.0, 1000.0);
  requireRange("context density", appearance.contextDensity, 0.0, 1.0);
  requireRange("context saturation", appearance.contextSaturation, 0.0, 1.0);
  request.transfer = appearance.transfer;
  request.shift = appearance.transferShift;
  request.density = appearance.density;
  request.gradient = appearance.gradient == Gradient::central ? core::GradientKind::central
                                                              : core::GradientKind::sobel;
  request.table = appearance.table == TableRemoval::keep     ? core::TableRequest::keep
                  : appearance.table == TableRemoval::remove ? core::TableRequest::remove
                                                             : core::TableRequest::automatic;
  request.materials = appearance.materials;
  request.materialChanges = appearance.materialChanges;
  if (!request.materialChanges.empty() && !request.materials)
    request.materials = core::libraryMaterials;
  request.lights = appearance.lights;
  if (appearance.environment) {
    const Color& color = *appearance.environment;
    for (const double channel : color)
      requireRange("environment", channel, 0.0, 1e6);
    request.environment = core::Rgb(color[0], color[1], color[2]);
  }
  if (appearance.environmentMap)
    request.environmentMap = *appearance.environmentMap;
  using Kind = VolumeSmoothing::Kind;
  const VolumeSmoothing& smoothing = appearance.smoothing;
  if (smoothing.kind == Kind::given) {
    requireRange("smoothing", smoothing.noise, 0.0, 1e30);
    request.smoothing = {core::SmoothingRequest::Kind::given, smoothing.noise};
  } else if (smoothing.kind == Kind::automatic) {
    request.smoothing = {core::SmoothingRequest::Kind::automatic};
  }
}

} // namespace

void setOptions(const SceneOptions& options, core::RenderRequest& request) {
  request.focus = options.focus;
  for (const double margin : options.margins)
    requireRange("margin", margin, -1000.0, 1000.0);
  requireRange("label smoothing", options.labelSmoothing, 0.0, 100.0);
  core::FocusRequest& focus = request.focusStyle;
  focus.shaping = {options.margins, options.labelSmoothing};
  focus.hasOrganMargin = options.margins.empty();
  focus.contextExtinction = options.appearance.contextDensity;
  focus.contextSaturation = options.appearance.contextSaturation;
  request.view = makeView(options.view);
  if (request.view.isAutomatic() && options.focus.empty())
    throw core::requestError(core::ErrorCode::focusRequired, "view", "auto requires a focus");
  request.clip = makeClip(options.clip, !options.focus.empty());
  setAppearance(options.appearance, request);
}

} // namespace v1
} // namespace fenestra
