#include "scene/SceneInput.h"

#include "core/Error.h"
#include "io/medical/DicomSeries.h"
#include "io/medical/SegmentationReader.h"
#include "io/medical/VolumeReader.h"
#include "io/mrml/ScenePlan.h"

namespace fenestra {
namespace {

std::array<double, 2> rangeOf(const Volume& volume) {
  return {volume.minimum, volume.maximum};
}

/// The segmentation by its name in the scene, else a file of that name.
void readSceneFocus(MrmlScene& scene, const ScenePlan& plan, const SceneRequest& request,
                    SceneInput& input) {
  const Grid& volume = input.volume.grid;
  if (plan.segmentation) {
    const Segmentation segmentation = readSceneSegmentation(scene, *plan.segmentation, &volume);
    input.focus = scene.files.knowingly([&] { return segmentation.mask(request.focus, volume); });
    return;
  }
  if (!std::filesystem::exists(*request.segmentation))
    throw inputError(scene.document.source(),
                     "has no segmentation \"" + *request.segmentation +
                         "\", and there is no file of that name; fenestra inspect lists what "
                         "there is");
  input.focus = readSegmentation(*request.segmentation, &volume).mask(request.focus, volume);
}

void readLook(MrmlScene& scene, const ScenePlan& plan, SceneInput& input) {
  if (plan.followed) {
    input.transfer = followedDisplay(*plan.rendering, *plan.followed, rangeOf(input.volume));
    input.transferName = "the volume's window and level";
  }
  if (!input.transfer && plan.property) {
    input.transfer = readSceneProperty(scene, *plan.property);
    input.transferName = plan.property->name;
  }
}

Background backgroundOf(const MrmlNode& view) {
  const ViewBackground colors = viewBackground(view);
  return Background::gradient(colors.bottom, colors.top);
}

SceneInput loadScene(const SceneRequest& request) {
  MrmlScene scene(request.input);
  const ScenePlan plan =
      planRender(scene.document, {request.volume, request.segmentation, !request.focus.empty()});
  SceneInput input{.volume = readSceneVolume(scene, *plan.volume)};
  if (!request.transfer)
    readLook(scene, plan, input);
  if (plan.roi)
    input.crop = readSceneRoi(scene, *plan.roi);
  if (!request.focus.empty())
    readSceneFocus(scene, plan, request, input);
  if (plan.camera && request.view.followsScene())
    input.camera = readSceneCamera(scene, *plan.camera);
  if (plan.view)
    input.background = backgroundOf(*plan.view);
  input.warnings = plan.warnings;
  return input;
}

Volume readVolumeOrSeries(const SceneRequest& request) {
  if (!std::filesystem::is_directory(request.input))
    return readVolume(request.input);
  const std::vector<DicomSeries> series = findDicomSeries(request.input);
  return readDicomVolume(chooseSeries(series, request.volume, request.input.string()));
}

SceneInput loadFiles(const SceneRequest& request) {
  SceneInput input{.volume = readVolumeOrSeries(request)};
  const Grid& volume = input.volume.grid;
  if (!request.focus.empty())
    input.focus = readSegmentation(*request.segmentation, &volume).mask(request.focus, volume);
  return input;
}

} // namespace

SceneInput loadInput(const SceneRequest& request) {
  SceneInput input = isSceneFile(request.input) ? loadScene(request) : loadFiles(request);
  input.warnings.insert(input.warnings.begin(), input.volume.warnings.begin(),
                        input.volume.warnings.end());
  return input;
}

} // namespace fenestra
