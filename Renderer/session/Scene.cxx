#include "session/Scene.h"

#include "base/Error.h"
#include "base/Stopwatch.h"
#include "base/TextStream.h"
#include "clip/surface/SteadySurface.h"
#include "files/looks/LightReader.h"
#include "files/looks/LookText.h"
#include "session/Defaults.h"

namespace fenestra {
namespace {

NamedLights requestedLights(const SceneRequest& request) {
  NamedLights named = namedLights(request.lights);
  if (request.environment || request.environmentMap) {
    std::erase_if(named.lights,
                  [](const Light& l) { return std::holds_alternative<EnvironmentLight>(l); });
    EnvironmentLight environment;
    if (request.environment)
      environment.radiance = *request.environment;
    else
      environment.map = readEnvironmentMap(*request.environmentMap);
    named.lights.emplace_back(environment);
  }
  return named;
}

TransferFunction fitted(const TransferLook& look, const Volume& volume) {
  if (!look.relative)
    return look.function;
  const auto [low, high] = usualRange(volume);
  return look.over(low, high);
}

std::string nameOf(Modality modality) {
  switch (modality) {
  case Modality::ct:
    return "CT";
  case Modality::mr:
    return "MR";
  case Modality::us:
    break;
  }
  return "ultrasound";
}

/// Throws Error (input) above a limit of the extinction: null collisions take time in proportion to
/// the greatest extinction, and a file could make paths endless.
void checkExtinction(const TransferFunction& transfer, const Volume& volume,
                     const std::string& name) {
  constexpr double thickest = 1e7; // optical depth across the volume
  double greatest = 0.0;
  for (const auto& knot : transfer.extinction.knots())
    greatest = std::max(greatest, knot.value[0]);
  const double allowed = thickest / (2.0 * volume.grid.boundingRadius());
  if (greatest <= allowed)
    return;
  TextWriter line;
  line << "extinction: reaches " << greatest << " per mm, and " << allowed
       << " is opaque in any picture of this volume; lower it or --density";
  throw inputError(name, line.str());
}

/// Focus depths at the viewport's pixels, mm.
std::vector<double> viewportDepths(const FocusDepth& focus, const Camera& camera) {
  std::vector<double> depths;
  for (int row = 0; row < camera.height(); ++row)
    for (int column = 0; column < camera.width(); ++column)
      depths.push_back(focus.depth.at(focus.depth.viewportSample(column, row)));
  return depths;
}

template <typename T>
bool same(const T& a, const T& b) {
  return a == b;
}
bool same(const std::optional<Rgb>& a, const std::optional<Rgb>& b) {
  return a.has_value() == b.has_value() && (!a || (*a == *b).all());
}

bool dependsOnCamera(const Light& light) {
  const auto* area = std::get_if<AreaLight>(&light);
  return area && area->frame == LightFrame::camera;
}

} // namespace

Scene::Scene(const SceneRequest& request) {
  make(request, nullptr);
}

Scene Scene::changed(const SceneRequest& request) const {
  Scene scene = *this;
  scene.m_seconds = {};
  scene.m_made = {};
  scene.make(request, &m_request);
  return scene;
}

void Scene::make(const SceneRequest& request, const SceneRequest* before) {
  using R = SceneRequest;
  const auto differs = [&](auto... members) {
    return !before || (!same(request.*members, before->*members) || ...);
  };
  const bool newLights = differs(&R::lights, &R::environment, &R::environmentMap);
  if (newLights) { // small files first: errors come early
    NamedLights named = requestedLights(request);
    m_lightList = std::make_shared<const std::vector<Light>>(std::move(named.lights));
    m_lightFile = std::move(named.file);
  }

  m_made.volume = differs(&R::input, &R::volume);
  m_made.focus = m_made.volume || differs(&R::segmentation, &R::focus) ||
                 (before && request.focusLook.shaping != before->focusLook.shaping);
  m_made.transfer = m_made.volume || differs(&R::transfer, &R::transferFor, &R::shift, &R::density);
  const Stopwatch loading;
  if (m_made.transfer && request.transfer)
    m_named = namedTransfer(*request.transfer, request.input);
  if (m_made.volume)
    m_volume = std::make_shared<const VolumeInput>(loadVolume(request));
  if (m_made.volume || !sameSettings(request, *before))
    m_settings = loadSettings(request, volume());
  if (m_made.focus)
    readFocus(request);
  if (m_made.transfer)
    chooseTransfer(request);
  m_seconds.load = loading.seconds();

  if (m_made.focus || m_made.transfer)
    m_automaticView.reset();
  m_made.camera = m_made.focus || differs(&R::view, &R::width, &R::height) ||
                  (request.view.isAutomatic() && m_made.transfer);
  if (m_made.camera)
    placeCamera(request);
  m_made.lights = m_made.volume || newLights ||
                  (m_made.camera && std::ranges::any_of(*m_lightList, dependsOnCamera));
  if (m_made.lights)
    m_lights = std::make_shared<const LightSet>(*m_lightList, volume().grid, *m_camera);
  m_made.clip = m_made.camera || differs(&R::clip, &R::measure, &R::steadyDegrees);
  if (m_made.clip)
    buildClip(request);

  const Stopwatch classifying;
  const int apron = MajorantGrid::apronFor(*m_transfer);
  m_made.ranges = m_made.volume || m_ranges->apron() != apron;
  if (m_made.ranges)
    m_ranges = std::make_shared<const CellRanges>(volume(), apron);
  const bool newStyle = m_made.focus || differs(&R::focusLook);
  if (newStyle)
    styleContext(request.focusLook);
  m_made.majorants = m_made.ranges || m_made.transfer || m_made.clip || newStyle;
  if (m_made.majorants)
    m_majorants = std::make_shared<const MajorantGrid>(volume().grid, *m_ranges, *m_transfer,
                                                       m_clip, style());
  m_seconds.classify = classifying.seconds();
  m_request = request;
}

void Scene::readFocus(const SceneRequest& request) {
  std::optional<FocusInput> focus = loadFocus(request, volume().grid);
  m_focus = focus ? std::make_shared<const FocusInput>(std::move(*focus)) : nullptr;
}

/// Chooses the request's transfer function (m_named), else the scene's, else one that suits the
/// volume.
void Scene::chooseTransfer(const SceneRequest& request) {
  m_lookWarnings.clear();
  const bool unsuitable = request.transferFor && !suits(*request.transferFor, volume());
  if (!request.transfer) {
    m_look = m_settings.transferName;
    m_transfer = m_settings.transfer;
  } else if (unsuitable) {
    m_transfer.reset();
    m_lookWarnings.push_back("the preset's transfer function is made for " +
                             nameOf(*request.transferFor) +
                             ", and the volume is none; it gets a look of its own, else name one "
                             "with --transfer");
  } else {
    m_look = isLookText(*request.transfer) ? "--transfer" : *request.transfer;
    m_transfer = fitted(m_named->look, volume());
  }
  if (!m_transfer) {
    const std::optional<std::string> preset = transferPresetFor(volume());
    m_look = preset.value_or("by the volume's range");
    m_transfer = preset ? namedTransfer(*preset, {}).look.function : relativeTransfer(volume());
  }
  m_transfer = m_transfer->shifted(request.shift).scaled(request.density);
  checkExtinction(*m_transfer, volume(), request.transfer ? m_look : volume().name);
  if (m_transfer->shading && volume().minimum == volume().maximum)
    throw inputError(volume().name,
                     "every voxel has the same value, so there is no gradient for the transfer "
                     "function's shading; use one with shading off (\"shading\": \"volume\")");
}

void Scene::placeCamera(const SceneRequest& request) {
  if (request.view.isAutomatic() && focus() && !m_automaticView)
    m_automaticView = automaticView(ViewScorer(volume(), domain(), *m_transfer, *focus()));
  const CameraPose pose = m_settings.camera
                              ? adjustedView(request.view, *m_settings.camera)
                              : frameView(request.view, domain(), focus(), request.width,
                                          request.height, m_automaticView);
  m_camera.emplace(pose, request.width, request.height);
}

void Scene::styleContext(const FocusRequest& request) {
  m_style.reset();
  if (m_focus && request.isStyled())
    m_style = ContextStyle{std::shared_ptr<const Mask>(m_focus, &m_focus->mask),
                           request.contextExtinction, request.contextSaturation};
}

void Scene::buildClip(const SceneRequest& request) {
  m_clip = ClipNone();
  m_focusDepth.clear();
  m_mismatch.reset();
  m_boundary.reset();
  m_controlPoints.clear();
  m_clipWarnings.clear();
  const ClipMode mode = request.clip.modeWith(focus() != nullptr);
  if (isDepthClip(mode))
    return buildDepthClip(mode, request);
  std::optional<FocusDepth> depth;
  const bool wantsPlane = mode == ClipMode::plane && !request.clip.plane;
  if (focus() && (wantsPlane || request.measure)) {
    const Stopwatch watch;
    depth = traceFocus(*m_camera, domain(), *focus());
    m_focusDepth = viewportDepths(*depth, *m_camera);
    m_seconds.focus = watch.seconds();
  }
  if (mode == ClipMode::plane)
    m_clip = placedPlane(request.clip, depth);
  if (depth && request.measure && mode == ClipMode::plane)
    m_boundary = measureBoundary(m_clip, domain(), *focus(), *depth);
}

ClipPlane Scene::placedPlane(const ClipRequest& request,
                             const std::optional<FocusDepth>& depth) const {
  if (!request.plane)
    requireVisible(*depth, *focus());
  ClipPlane plane = request.plane
                        ? ClipPlane{*m_camera, request.plane->origin, request.plane->normal}
                        : focusPlane(*m_camera, *depth);
  plane.point += request.surface.offset * m_camera->forward();
  plane.edge = {0.0, request.surface.edge.softness};
  return plane;
}

void Scene::buildDepthClip(ClipMode mode, const SceneRequest& scene) {
  const bool isSurface = mode == ClipMode::surface || mode == ClipMode::ghost;
  SurfaceOptions options = scene.clip.surface;
  options.mode = isSurface ? SurfaceMode::surface
                           : (mode == ClipMode::hole ? SurfaceMode::hole : SurfaceMode::cutaway);
  if (mode == ClipMode::ghost)
    options.edge.ghost = double{static_cast<float>(scene.clip.ghost)};
  ClippingSurface surface =
      buildSteadySurface(*m_camera, domain(), *focus(), options, scene.steadyDegrees);
  m_focusDepth = viewportDepths(surface.focus, *m_camera);
  m_clip = std::move(surface.clip);
  if (scene.measure)
    m_boundary = measureBoundary(m_clip, domain(), *focus(), surface.focus);
  m_mismatch = surface.mismatch;
  if (isSurface && !m_mismatch && m_boundary)
    m_mismatch = m_boundary->gap;
  m_seconds.focus = surface.focusSeconds;
  m_seconds.spline = surface.splineSeconds;
  m_seconds.fill = surface.fillSeconds;
  m_clipWarnings = surface.warnings;
  m_controlPoints = std::move(surface.controlPoints);
}

std::vector<std::string> Scene::warnings() const {
  std::vector<std::string> warnings = m_request.leftOut;
  warnings.insert(warnings.end(), volume().warnings.begin(), volume().warnings.end());
  warnings.insert(warnings.end(), m_settings.warnings.begin(), m_settings.warnings.end());
  warnings.insert(warnings.end(), m_lookWarnings.begin(), m_lookWarnings.end());
  if (domain().indexCorners().empty())
    warnings.emplace_back("the cropping box lies outside the volume: nothing is left of it");
  warnings.insert(warnings.end(), m_clipWarnings.begin(), m_clipWarnings.end());
  return warnings;
}

std::vector<std::string> Scene::files() const {
  std::vector<std::string> files = m_volume->files;
  files.insert(files.end(), m_settings.files.begin(), m_settings.files.end());
  if (m_focus)
    files.insert(files.end(), m_focus->files.begin(), m_focus->files.end());
  if (m_request.transfer && !m_named->file.empty())
    files.push_back(m_named->file);
  if (!m_lightFile.empty())
    files.push_back(m_lightFile);
  if (m_request.environmentMap)
    files.push_back(m_request.environmentMap->string());
  std::ranges::sort(files);
  files.erase(std::unique(files.begin(), files.end()), files.end());
  return files;
}

} // namespace fenestra
