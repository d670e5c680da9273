#include "fenestra/Scene.h"

#include "clip/mesh/SurfaceMesh.h"
#include "io/InputRegistry.h"
#include "library/Convert.h"
#include "library/Data.h"
#include "scene/FinishedImage.h"

#include <tbb/task_arena.h>

namespace fenestra {
inline namespace v1 {

core::PreparedScene Scene::Data::prepare(int width, int height, bool hasFeatures,
                                         const core::StopFlag& stop) {
  constexpr int most = 65536;
  if (width < 1 || height < 1 || width > most || height > most)
    throw core::requestError(core::ErrorCode::invalidValue, "size",
                             "must be from 1 x 1 to 65536 x 65536 pixels");
  core::RenderRequest wanted = request;
  wanted.width = width;
  wanted.height = height;
  wanted.features = hasFeatures;
  core::checkMemory(wanted);
  const std::lock_guard lock(mutex);
  const auto reading = allowReading(isReadInProcess);
  // Isolated: while it waits, this thread must not take a task that waits for the lock.
  tbb::this_task_arena::isolate([&] {
    prepared =
        prepared ? prepared->withRequest(wanted, stop) : core::PreparedScene(wanted, input, stop);
  });
  return *prepared;
}

namespace {

/// What chooses among several volumes and segmentations of a file, and how it is read.
struct Sources {
  core::VolumeChoice volume = {};
  std::optional<std::string> segmentation = {}, labels = {};
  bool isReadInProcess = false;
};

std::shared_ptr<Scene::Data> share(core::Input input, const SceneOptions& options,
                                   const Sources& sources = {},
                                   const Scene::Data* previous = nullptr) {
  const auto reading = allowReading(sources.isReadInProcess);
  core::RenderRequest request;
  request.input = input.path();
  request.volume = sources.volume;
  request.segmentation = sources.segmentation;
  request.labels = sources.labels;
  SceneOptions complete = options;
  std::optional<core::ChosenPreset> preset;
  if (options.preset && previous && previous->options.preset == options.preset &&
      previous->options.focus == options.focus)
    preset = previous->preset; // does not read the names of segments again
  else if (options.preset)
    preset = core::chooseOrganPreset(
        *options.preset, input,
        {sources.volume.name, sources.segmentation, sources.labels, options.focus}, sources.volume);
  if (preset)
    request.transferModality = applyPreset(*preset, complete);
  setOptions(complete, request);
  return std::shared_ptr<Scene::Data>(new Scene::Data{std::move(input), std::move(request), options,
                                                      std::move(preset), sources.isReadInProcess});
}

/// Throws core::Error if a segment of the focus does not exist.
void requireSegments(const core::SegmentsHandle& segments, const std::vector<std::string>& focus) {
  if (!segments && !focus.empty())
    throw core::requestError(core::ErrorCode::segmentationRequired, "focus",
                             "requires a segmentation, which holds its segments");
  for (const std::string& selector : focus)
    segments->segmentation.find(selector);
}

/// Segments of the input; nullopt: it has no segmentation.
std::optional<core::SegmentNames> readSegments(const Scene::Data& data) {
  const auto reading = allowReading(data.isReadInProcess);
  const core::RenderRequest& request = data.request;
  const core::InputChoice choice = {request.volume.name, request.segmentation, request.labels};
  auto names = data.input.segmentNames(choice);
  if (names && names->segments.empty()) // they are named by their values
    names->segments = data.input.segments(choice)->segmentation.segments();
  return names;
}

core::PreparedScene prepare(const std::shared_ptr<Scene::Data>& data, int width, int height) {
  return data->prepare(width, height, false);
}

} // namespace

Scene::Scene(const Volume& volume, const SceneOptions& options)
    : m_data(guard([&] {
        requireSegments(nullptr, options.focus);
        return share(core::Input(volume.data()->input, nullptr), options);
      })) {}

Scene::Scene(const Volume& volume, const Segmentation& segmentation, const SceneOptions& options)
    : m_data(guard([&] {
        const core::SegmentsHandle& segments = segmentation.data()->input;
        const core::VolumeHandle& voxels = volume.data()->input;
        requireSegments(segments, options.focus);
        auto data = share(core::Input(voxels, segments), options);
        data->request.omissions =
            core::checkPosition("segmentation", segments->segmentation.grid(), voxels->volume.grid);
        return data;
      })) {}

Scene::Scene(std::shared_ptr<Data> data) : m_data(std::move(data)) {}

Scene Scene::withOptions(const SceneOptions& options) const {
  return guard([&] {
    const std::lock_guard lock(m_data->mutex);
    if (m_data->input.path().empty() && !options.focus.empty())
      requireSegments(m_data->input.segments({}), options.focus);
    const core::RenderRequest& own = m_data->request;
    std::shared_ptr<Data> changed =
        share(m_data->input, options,
              {own.volume, own.segmentation, own.labels, m_data->isReadInProcess}, m_data.get());
    changed->request.omissions = own.omissions;
    changed->prepared = m_data->prepared;
    return Scene(std::move(changed));
  });
}

const SceneOptions& Scene::options() const {
  return m_data->options;
}

std::vector<Segment> Scene::segments() const {
  return guard([&] {
    const auto names = readSegments(*m_data);
    return names ? toSegments(names->segments) : std::vector<Segment>();
  });
}

std::vector<Warning> Scene::warnings(int width, int height) const {
  return guard([&] { return toWarnings(prepare(m_data, width, height).warnings()); });
}

std::vector<std::string> Scene::choices(int width, int height) const {
  return guard([&] { return prepare(m_data, width, height).choices(); });
}

Camera Scene::camera(int width, int height) const {
  return guard([&] {
    const core::CameraPose pose = prepare(m_data, width, height).camera().pose();
    const bool isPerspective = pose.projection == core::Projection::perspective;
    return Camera{isPerspective ? Projection::perspective : Projection::orthographic,
                  toVector3(pose.position),
                  toVector3(pose.target),
                  toVector3(pose.up),
                  pose.scale,
                  pose.angle};
  });
}

ClipSurface Scene::clipSurface(int width, int height) const {
  return guard([&] {
    const core::PreparedScene scene = prepare(m_data, width, height);
    const auto* const clip = std::get_if<core::ClipDepth>(&scene.clip());
    if (!clip)
      throw core::requestError(core::ErrorCode::focusRequired, "clip",
                               "is no surface; it needs a focus and a mode such as surface");
    core::SurfaceMesh mesh =
        core::buildSurfaceMesh(*clip, scene.domain(), core::surfaceTolerance(clip->camera));
    ClipSurface surface{{}, std::move(mesh.depths), std::move(mesh.triangles)};
    for (const core::Vec3& point : mesh.points)
      surface.points.push_back(toVector3(point));
    return surface;
  });
}

Scene readScene(const std::string& path, const std::optional<std::string>& segmentation,
                const std::optional<std::string>& labels, const SceneOptions& scene,
                const ReadOptions& options) {
  return guard([&] {
    if (!core::fileExists(path))
      throw core::inputError(core::ErrorCode::missingFile, path, "no such file; check the name");
    auto data = share(core::Input(path), scene,
                      {makeChoice(options), segmentation, labels, options.isInProcess});
    if (const auto names = scene.focus.empty() ? std::nullopt : readSegments(*data))
      for (const std::string& selector : scene.focus)
        core::findSegment(names->segments, selector, names->source);
    return Scene(std::move(data));
  });
}

} // namespace v1
} // namespace fenestra
