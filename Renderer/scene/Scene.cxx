#include "scene/Scene.h"

#include "core/Error.h"
#include "core/Stopwatch.h"
#include "io/EmbeddedResources.h"
#include "io/looks/LightReader.h"
#include "io/looks/TransferReader.h"
#include "scene/Defaults.h"

#include <sstream>

namespace fenestra {
namespace {

/// What `name` means under Resources/<kind>/: the text of a preset, empty where there is none.
std::string_view preset(const std::string& kind, const std::string& name) {
  return embeddedResource(kind + "/" + name + ".json");
}

/// A name without a dot is a preset's; so is no file's.
Error unknownPreset(const std::string& flag, const std::string& kind, const std::string& name) {
  std::string known;
  for (const std::string& path : embeddedResourceNames(kind + "/"))
    known += (known.empty() ? "" : ", ") +
             path.substr(kind.size() + 1, path.size() - kind.size() - 1 - std::strlen(".json"));
  return inputError(name, "no such file, and no preset of that name; --" + flag +
                              " takes a file or one of " + known);
}

TransferFunction namedTransfer(const std::string& name) {
  if (const std::string_view text = preset("transfer", name); !text.empty())
    return parseTransferFunction(text, name);
  if (!std::filesystem::exists(name))
    throw unknownPreset("transfer", "transfer", name);
  return readTransferFunction(name);
}

std::vector<Light> requestedLights(const SceneRequest& request) {
  std::vector<Light> lights;
  if (const std::string_view text = preset("lights", request.lights); !text.empty())
    lights = parseLights(text, request.lights);
  else if (!std::filesystem::exists(request.lights))
    throw unknownPreset("lights", "lights", request.lights);
  else
    lights = readLights(request.lights);

  if (request.environment || request.environmentMap) {
    std::erase_if(lights,
                  [](const Light& l) { return std::holds_alternative<EnvironmentLight>(l); });
    EnvironmentLight environment;
    if (request.environment)
      environment.radiance = *request.environment;
    else
      environment.map = readEnvironmentMap(*request.environmentMap);
    lights.emplace_back(environment);
  }
  return lights;
}

/// Null collisions take time in proportion to the greatest extinction: without a limit a file could
/// ask for paths that never end.
void checkExtinction(const TransferFunction& transfer, const Volume& volume,
                     const std::string& name) {
  constexpr double thickest = 1e7; // optical depth across the volume
  double greatest = 0.0;
  for (const auto& knot : transfer.extinction.knots())
    greatest = std::max(greatest, knot.value[0]);
  const double allowed = thickest / (2.0 * volume.grid.boundingRadius());
  if (greatest <= allowed)
    return;
  std::ostringstream line;
  line << "extinction: reaches " << greatest << " per mm, and " << allowed
       << " is opaque in any picture of this volume; lower it or --density";
  throw inputError(name, line.str());
}

/// The focus depths at the viewport's pixels.
std::vector<double> viewportDepths(const FocusDepth& focus, const Camera& camera) {
  std::vector<double> depths;
  for (int row = 0; row < camera.height(); ++row)
    for (int column = 0; column < camera.width(); ++column)
      depths.push_back(focus.depth.at(focus.depth.viewportSample(column, row)));
  return depths;
}

} // namespace

Scene::Scene(const SceneRequest& request) {
  const std::vector<Light> lights =
      requestedLights(request); // small files first: errors come early
  load(request);
  placeCamera(request);
  m_lights.emplace(lights, m_volume.grid, *m_camera);
  buildClip(request);
  classify();
}

void Scene::load(const SceneRequest& request) {
  const Stopwatch watch;
  if (request.transfer)
    m_transfer = namedTransfer(*request.transfer);
  SceneInput input = loadInput(request);
  m_volume = std::move(input.volume);
  m_focus = std::move(input.focus);
  m_crop = input.crop;
  m_sceneCamera = input.camera;
  m_background = input.background;
  m_warnings = input.warnings;
  if (domain().indexCorners().empty())
    m_warnings.emplace_back("the cropping box lies outside the volume: nothing is left of it");
  chooseTransfer(request, input);
  m_seconds.load = watch.seconds();
}

/// The request's, else the scene's, else what suits the volume.
void Scene::chooseTransfer(const SceneRequest& request, const SceneInput& input) {
  m_look = request.transfer.value_or(input.transferName);
  if (!m_transfer && input.transfer)
    m_transfer = input.transfer;
  if (!m_transfer) {
    const std::optional<std::string> preset = transferPresetFor(m_volume);
    m_look = preset.value_or("by the volume's range");
    m_transfer = preset ? namedTransfer(*preset) : relativeTransfer(m_volume);
  }
  m_transfer = m_transfer->shifted(request.shift).scaled(request.density);
  checkExtinction(*m_transfer, m_volume, request.transfer.value_or(m_volume.name));
  if (m_transfer->shading && m_volume.minimum == m_volume.maximum)
    throw inputError(m_volume.name,
                     "every voxel has the same value, so there is no gradient for the transfer "
                     "function's shading; use one with shading off (\"shading\": \"volume\")");
}

void Scene::placeCamera(const SceneRequest& request) {
  const CameraPose pose = m_sceneCamera
                              ? adjustedView(request.view, *m_sceneCamera)
                              : frameView(request.view, domain(), m_focus ? &*m_focus : nullptr,
                                          request.width, request.height);
  m_camera.emplace(pose, request.width, request.height);
}

void Scene::buildClip(const SceneRequest& request) {
  const ClipMode mode = request.clip.mode.value_or(m_focus ? ClipMode::surface : ClipMode::none);
  switch (mode) {
  case ClipMode::cutaway:
    return buildDepthClip(SurfaceMode::cutaway, request.clip);
  case ClipMode::surface:
    return buildDepthClip(SurfaceMode::surface, request.clip);
  case ClipMode::plane:
    m_clip = ClipPlane{*m_camera, request.clip.plane->origin, request.clip.plane->normal};
    break;
  case ClipMode::none:
    break;
  }
  if (!m_focus || !request.measureCoverage)
    return;
  const Stopwatch watch;
  m_focusDepth = viewportDepths(traceFocus(*m_camera, domain(), *m_focus), *m_camera);
  m_seconds.focus = watch.seconds();
}

void Scene::buildDepthClip(SurfaceMode mode, const ClipRequest& request) {
  ClippingSurface surface = buildClippingSurface(*m_camera, domain(), *m_focus,
                                                 {mode, request.controlPoints, request.smoothing});
  m_focusDepth = viewportDepths(surface.focus, *m_camera);
  m_clip = std::move(surface.clip);
  if (mode == SurfaceMode::surface)
    m_mismatch = surface.mismatch;
  m_seconds.focus = surface.focusSeconds;
  m_seconds.spline = surface.splineSeconds;
  m_seconds.fill = surface.fillSeconds;
  m_warnings.insert(m_warnings.end(), surface.warnings.begin(), surface.warnings.end());
}

void Scene::classify() {
  const Stopwatch watch;
  const CellRanges ranges(m_volume, MajorantGrid::apronFor(*m_transfer));
  m_majorants.emplace(m_volume.grid, ranges, *m_transfer, m_clip);
  m_seconds.classify = watch.seconds();
}

} // namespace fenestra
