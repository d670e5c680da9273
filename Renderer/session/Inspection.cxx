#include "session/Inspection.h"

#include "files/medical/DicomSeries.h"
#include "files/slicer/SceneFiles.h"
#include "session/Defaults.h"
#include "session/InspectionParts.h"

namespace fenestra {
namespace {

struct TypeName {
  const char* operator()(const std::vector<std::uint8_t>&) const { return "uint8"; }
  const char* operator()(const std::vector<std::int16_t>&) const { return "int16"; }
  const char* operator()(const std::vector<std::uint16_t>&) const { return "uint16"; }
  const char* operator()(const std::vector<float>&) const { return "float"; }
};

/// True if most pairs of neighbouring voxels above the least value are equal, as in label maps (at
/// least 59 % in those at hand) and in no scan (at most 8 %).
bool looksLikeLabels(const Volume& volume) {
  constexpr double most = 0.5;
  if (volume.minimum < 0.0 || std::holds_alternative<std::vector<float>>(volume.voxels))
    return false;
  std::size_t pairs = 0;
  std::size_t alike = 0;
  std::visit(
      [&](const auto& voxels) {
        const auto isLeast = [&](std::size_t i) {
          return static_cast<double>(voxels[i]) == volume.minimum;
        };
        for (std::size_t i = 1; i < voxels.size(); ++i)
          if (!isLeast(i) || !isLeast(i - 1)) {
            ++pairs;
            alike += voxels[i] == voxels[i - 1];
          }
      },
      volume.voxels);
  return static_cast<double>(alike) > most * static_cast<double>(pairs);
}

bool isNamedSegmentation(const std::filesystem::path& path) {
  return path.filename().string().find(".seg.") != std::string::npos;
}

SegmentationSummary readSegments(const std::filesystem::path& path,
                                 const std::optional<Grid>& volume, std::optional<Error>& failure) {
  SegmentationSummary summary{.node = {.id = "", .name = path.string()}};
  if (const auto segmentation =
          attempted([&] { return readSegmentation(path, volume ? &*volume : nullptr); }, failure))
    describe(*segmentation, {}, summary);
  else
    summary.node.problem = failure->what();
  return summary;
}

/// Use of a volume by a render, and whether the volume could be a label map. The volume itself is
/// released before segments are read.
struct FileVolume {
  std::optional<Grid> grid = {};
  std::optional<RenderUse> render = {};
  std::optional<Error> failure = {};
  std::vector<std::string> warnings = {};
  bool looksLikeLabels = false;
};

FileVolume inspectVolume(const SceneRequest& request) {
  FileVolume result;
  const auto describeVolume = [&result](const Volume& volume) {
    result.grid = volume.grid;
    result.render.emplace();
    result.render->volume = volumeUse(volume);
    result.render->look = defaultLook(volume);
    result.looksLikeLabels = looksLikeLabels(volume);
  };
  const auto scene = attempted([&] { return std::make_unique<Scene>(request); }, result.failure);
  if (scene) {
    describeVolume((*scene)->volume());
    result.render->camera = CameraUse{"", "", (*scene)->camera().pose()};
    result.warnings = (*scene)->warnings();
    return result;
  }
  std::optional<Error> unreadable; // unused: the scene may have failed after the volume
  if (const auto input =
          attempted([&] { return Input(request.input).volume(request.volume); }, unreadable)) {
    describeVolume(input->volume);
    result.warnings = input->volume.warnings;
  }
  return result;
}

Inspection inspectFiles(const SceneRequest& request) {
  Inspection result;
  if (isFolder(request.input)) {
    result.kind = InputKind::dicom;
    for (const DicomSeries& series : findDicomSeries(request.input))
      result.series.push_back(
          {series.uid, series.number, series.description, series.modality, series.files.size()});
  }
  const FileVolume volume = inspectVolume(request);
  result.render = volume.render;
  result.warnings = volume.warnings;
  if (volume.failure)
    result.refused = volume.failure->what();

  std::optional<Error> failure;
  if (result.kind != InputKind::dicom &&
      (!volume.render || volume.looksLikeLabels || isNamedSegmentation(request.input))) {
    result.segmentations.push_back(readSegments(request.input, volume.grid, failure));
    if (!volume.render && failure)
      throw *volume.failure;
    result.kind = InputKind::segmentation;
  }
  if (request.segmentation) {
    result.segmentations.push_back(readSegments(*request.segmentation, volume.grid, failure));
    result.segmentations.back().node.used = true;
  }
  if (result.render && request.segmentation)
    result.render->segmentation = *request.segmentation;
  return result;
}

} // namespace

VolumeUse volumeUse(const Volume& volume) {
  return {.id = "",
          .name = volume.name,
          .size = volume.grid.size,
          .spacing = volume.grid.spacing(),
          .center = volume.grid.worldCenter(),
          .voxelType = std::visit(TypeName(), volume.voxels),
          .minimum = volume.minimum,
          .maximum = volume.maximum};
}

LookUse defaultLook(const Volume& volume) {
  const std::optional<std::string> preset = transferPresetFor(volume);
  return {preset ? LookSource::preset : LookSource::range, "", preset.value_or("")};
}

void describe(const Segmentation& segmentation, const std::map<std::string, bool>& shown,
              SegmentationSummary& summary) {
  constexpr double cubicMmInMl = 1000.0;
  const Grid& grid = segmentation.grid();
  summary.size = grid.size;
  summary.spacing = grid.spacing();
  const double milliliters = std::abs(grid.indexToWorld.linear().determinant()) / cubicMmInMl;
  const std::vector<SegmentStatistics> statistics = segmentation.statistics();
  for (std::size_t i = 0; i < statistics.size(); ++i) {
    const SegmentInfo& info = segmentation.segments()[i];
    const auto visible = shown.find(info.id);
    summary.segments.push_back(
        {.id = info.id,
         .name = info.name,
         .labelValue = info.labelValue,
         .layer = info.layer,
         .color = info.color,
         .voxels = statistics[i].voxels,
         .milliliters = milliliters * static_cast<double>(statistics[i].voxels),
         .bounds = statistics[i].bounds,
         .shown = visible == shown.end() || visible->second});
  }
}

Inspection inspectInput(const SceneRequest& request) {
  return isSceneFile(request.input) ? inspectScene(request) : inspectFiles(request);
}

} // namespace fenestra
