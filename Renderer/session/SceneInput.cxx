#include "session/SceneInput.h"

#include "base/Error.h"
#include "base/safe/Inputs.h"
#include "files/medical/DicomSeries.h"
#include "files/medical/VolumeReader.h"
#include "files/segments/SegmentationReader.h"
#include "files/slicer/ScenePlan.h"

#include <algorithm>

namespace fenestra {
namespace {

std::array<double, 2> rangeOf(const Volume& volume) {
  return {volume.minimum, volume.maximum};
}

ScenePlan planFor(const MrmlScene& scene, const SceneRequest& request) {
  return planRender(scene.document, {request.volume, request.segmentation, !request.focus.empty()});
}

void readLook(MrmlScene& scene, const ScenePlan& plan, const Volume& volume,
              SceneSettings& settings) {
  if (plan.followed) {
    settings.transfer = followedDisplay(*plan.rendering, *plan.followed, rangeOf(volume));
    settings.transferName = "the volume's window and level";
  }
  if (!settings.transfer && plan.property) {
    settings.transfer = readSceneProperty(scene, *plan.property);
    settings.transferName = plan.property->name;
  }
}

Background backgroundOf(const MrmlNode& view) {
  const ViewBackground colors = viewBackground(view);
  return Background::gradient(colors.bottom, colors.top);
}

VolumeInput volumeInScene(const SceneRequest& request) {
  MrmlScene scene(request.input);
  const ScenePlan plan = planFor(scene, request);
  Volume volume = readSceneVolume(scene, *plan.volume);
  return {std::move(volume), scene.files.filesRead()};
}

VolumeInput volumeInFiles(const SceneRequest& request) {
  if (!isFolder(request.input))
    return {readVolume(request.input), {request.input.string()}};
  const std::vector<DicomSeries> all = findDicomSeries(request.input);
  const DicomSeries& series = chooseSeries(all, request.volume, request.input.string());
  VolumeInput input{readDicomVolume(series)};
  for (const auto& file : series.files)
    input.files.push_back(file.string());
  return input;
}

/// Focus from a segmentation file, for any kind of input.
FocusInput focusInFile(const SceneRequest& request, const Grid& volume) {
  return {readSegmentation(*request.segmentation, &volume)
              .mask(request.focus, volume, request.focusLook.shaping),
          {*request.segmentation}};
}

/// Focus from the segmentation of that name in the scene, else from a file of that name.
FocusInput focusInScene(const SceneRequest& request, const Grid& volume) {
  MrmlScene scene(request.input);
  const ScenePlan plan = planFor(scene, request);
  if (plan.segmentation) {
    const Segmentation segmentation = readSceneSegmentation(scene, *plan.segmentation, &volume);
    Mask mask = scene.files.knowingly(
        [&] { return segmentation.mask(request.focus, volume, request.focusLook.shaping); });
    return {std::move(mask), scene.files.filesRead()};
  }
  if (!isThere(*request.segmentation))
    throw inputError(scene.document.source(),
                     "has no segmentation \"" + *request.segmentation +
                         "\", and there is no file of that name; fenestra inspect lists what "
                         "there is");
  return focusInFile(request, volume);
}

} // namespace

VolumeInput loadVolume(const SceneRequest& request) {
  return isSceneFile(request.input) ? volumeInScene(request) : volumeInFiles(request);
}

SceneSettings loadSettings(const SceneRequest& request, const Volume& volume) {
  SceneSettings settings;
  if (!isSceneFile(request.input))
    return settings;
  MrmlScene scene(request.input);
  const ScenePlan plan = planFor(scene, request);
  if (!request.transfer)
    readLook(scene, plan, volume, settings);
  if (plan.roi)
    settings.crop = readSceneRoi(scene, *plan.roi);
  if (plan.camera && request.view.followsScene())
    settings.camera = readSceneCamera(scene, *plan.camera);
  if (plan.view)
    settings.background = backgroundOf(*plan.view);
  settings.warnings = plan.warnings;
  settings.files = scene.files.filesRead();
  return settings;
}

bool sameSettings(const SceneRequest& a, const SceneRequest& b) {
  return a.transfer.has_value() == b.transfer.has_value() &&
         a.view.followsScene() == b.view.followsScene();
}

std::optional<SegmentNames> loadSegmentNames(const SceneRequest& request) {
  const auto inFile = [&request]() -> std::optional<SegmentNames> {
    if (!request.segmentation)
      return std::nullopt;
    return SegmentNames{*request.segmentation, readSegmentInfos(*request.segmentation)};
  };
  if (!isSceneFile(request.input))
    return inFile();
  MrmlScene scene(request.input);
  const bool holdsAny = std::ranges::any_of(scene.document.nodes(), [](const MrmlNode& node) {
    return node.tag == "Segmentation" || isLabelMap(node);
  });
  const ScenePlan plan =
      planRender(scene.document, {request.volume, request.segmentation, holdsAny});
  if (!plan.segmentation)
    return inFile();
  return SegmentNames{scene.document.source() + ": " + shown(*plan.segmentation),
                      readSceneSegmentInfos(scene, *plan.segmentation)};
}

std::optional<FocusInput> loadFocus(const SceneRequest& request, const Grid& volume) {
  if (request.focus.empty())
    return std::nullopt;
  return isSceneFile(request.input) ? focusInScene(request, volume) : focusInFile(request, volume);
}

} // namespace fenestra
