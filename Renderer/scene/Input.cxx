#include "scene/Input.h"

#include "base/Error.h"
#include "files/medical/DicomReader.h"
#include "files/medical/DicomSeries.h"
#include "files/medical/ImageStack.h"
#include "files/medical/MedicalHeader.h"
#include "files/medical/NiftiForms.h"
#include "files/medical/VolumeReader.h"
#include "files/segments/MaskFolder.h"
#include "files/slicer/FocusNodes.h"
#include "files/slicer/ScenePlan.h"
#include "io/InputRegistry.h"

#include <algorithm>
#include <mutex>

namespace fenestra::core {
namespace {

ScenePlan makePlan(const MrmlScene& scene, const InputChoice& choice, bool needsSegmentation) {
  return planRender(scene.document, {choice.volume, choice.segmentation, needsSegmentation});
}

InputFiles toInputFiles(const std::vector<std::filesystem::path>& paths) {
  InputFiles files;
  std::ranges::transform(paths, std::back_inserter(files),
                         [](const auto& path) { return path.string(); });
  return files;
}

std::optional<SegmentNames> readSegmentNames(const InputChoice& choice) {
  if (!choice.segmentation)
    return std::nullopt;
  return SegmentNames{*choice.segmentation, readSegmentInfos(*choice.segmentation, choice.labels)};
}

/// Segmentation files that have all segments of a focus.
std::vector<std::filesystem::path> selectByFocus(std::vector<std::filesystem::path> files,
                                                 const std::vector<std::string>& focus) {
  std::erase_if(files, [&](const std::filesystem::path& file) {
    const std::vector<SegmentInfo> segments = readSegmentInfos(file);
    return !std::ranges::all_of(focus, [&](const std::string& selector) {
      return std::ranges::any_of(
          segments, [&](const SegmentInfo& segment) { return isSelected(segment, selector); });
    });
  });
  return files;
}

/// Warning about a DICOM segmentation of another frame of reference than the series'.
std::vector<Message> checkFrameOfReference(const std::string& file, const DicomSeries& series) {
  const std::vector<DicomHeader> headers =
      isDicomFile(file) ? DicomReader().readHeaders(file) : std::vector<DicomHeader>();
  const std::string& own = series.frames.front().front().header.frameOfReference;
  if (headers.empty() || own.empty() || headers.front().frameOfReference.empty() ||
      headers.front().frameOfReference == own)
    return {};
  return {makeMessage(ErrorCode::assumedGeometry, file,
                      "is placed in another frame of reference than the volume, as of another scan "
                      "or patient; its positions are used as they are")};
}

InputFiles listSegmentationFiles(const std::filesystem::path& path) {
  return isFolder(path) ? toInputFiles(listMaskFiles(path)) : InputFiles{path.string()};
}

/// A segmentation with the files from which it was read.
SegmentsInput makeSegments(Segmentation segmentation, InputFiles files) {
  if (fileExists(segmentation.namesSource()))
    files.push_back(segmentation.namesSource());
  return {std::move(segmentation), std::move(files)};
}

std::vector<const MrmlNode*> findNodesOfFocus(MrmlScene& scene, const InputChoice& choice) {
  return choice.segmentation ? std::vector<const MrmlNode*>()
                             : findFocusNodes(scene, choice.focus, choice.labels);
}

/// Segmentations that are searched first, if they are several and none is chosen; else empty.
SegmentationNodes findAlternatives(const MrmlScene& scene, const InputChoice& choice) {
  if (!choice.segmentation)
    for (const SegmentationNodes& nodes : listSegmentations(scene.document))
      if (!nodes.empty())
        return nodes.size() > 1 ? nodes : SegmentationNodes();
  return {};
}

/// Names of the segments of several nodes, together.
SegmentNames readNames(MrmlScene& scene, const SegmentationNodes& nodes,
                       const std::optional<std::string>& labels) {
  SegmentNames names{concat(scene.document.source(), ": ", nodes.size(), " segmentations"), {}};
  for (const MrmlNode* node : nodes)
    for (SegmentInfo& segment : readSceneSegmentInfos(scene, *node, labels))
      names.segments.push_back(std::move(segment));
  return names;
}

/// Segments of at least one node, together.
Segmentation readNodes(MrmlScene& scene, const std::vector<const MrmlNode*>& nodes,
                       const Grid* volume, const std::optional<std::string>& labels) {
  std::optional<Segmentation> all;
  for (const MrmlNode* node : nodes) {
    Segmentation one = readSceneSegmentation(scene, *node, volume, labels);
    const std::string source = scene.files.translatePaths(one.source());
    if (!all) {
      one.setSource(source);
      all.emplace(std::move(one));
    } else {
      all->setSource(concat(all->source(), ", ", source));
      all->add(std::move(one));
    }
  }
  return std::move(*all);
}

} // namespace

bool isDicomInput(const std::filesystem::path& path) {
  return isFolder(path) ? !isImageStack(path) : isDicomFile(path) && !findMedicalFormat(path);
}

struct Input::SharedState {
  /// Returns work(scene) under a lock. The first call opens the scene.
  template <typename Work>
  auto withScene(Work&& work) {
    const std::lock_guard lock(mutex);
    if (!scene)
      scene.emplace(path);
    scene->files.resetUsedFiles();
    return work(*scene);
  }

  bool isInMemory() const { return volume != nullptr; }

  std::filesystem::path path = {};
  VolumeHandle volume = {}; ///< this and the next: only in memory
  SegmentsHandle segments = {};
  bool isScene = false;
  std::mutex mutex = {};
  std::optional<MrmlScene> scene = {};
  std::optional<DicomFolder> dicom = {};
};

Input::Input(std::filesystem::path path) : m_state(std::make_shared<SharedState>()) {
  m_state->isScene = isSceneFile(path);
  m_state->path = std::move(path);
}

Input::Input(VolumeHandle volume, SegmentsHandle segments)
    : m_state(std::make_shared<SharedState>()) {
  m_state->volume = std::move(volume);
  m_state->segments = std::move(segments);
}

const std::filesystem::path& Input::path() const {
  return m_state->path;
}

bool Input::hasSeveralSegmentations() const {
  if (const DicomFolder* const folder = dicom())
    return folder->segmentations.size() > 1;
  const MrmlDocument* opened = document();
  return opened && std::ranges::count_if(opened->nodes(), isSegmentation) > 1;
}

const MrmlDocument* Input::document() const {
  const MrmlScene* opened = scene();
  return opened ? &opened->document : nullptr;
}

MrmlScene* Input::scene() const {
  if (!m_state->isScene)
    return nullptr;
  return m_state->withScene([](MrmlScene& scene) { return &scene; });
}

VolumeChoice Input::chooseForm(const VolumeChoice& given,
                               const std::optional<std::string>& segmentation) const {
  VolumeChoice choice = given;
  if (m_state->isInMemory() || m_state->isScene || isDicomInput(path()) || !segmentation)
    return choice;
  const auto readGrids = [&] {
    if (!isFolder(*segmentation))
      return readPossibleGrids(*segmentation);
    const auto masks = listMaskFiles(*segmentation);
    return masks.empty() ? std::vector<Grid>() : readPossibleGrids(masks.front());
  };
  chooseNiftiForm(path(), readGrids, *segmentation, choice);
  return choice;
}

const DicomFolder* Input::dicom() const {
  if (m_state->isInMemory() || m_state->isScene || !isDicomInput(path()))
    return nullptr;
  const std::lock_guard lock(m_state->mutex);
  if (!m_state->dicom)
    m_state->dicom = isFolder(path()) ? findDicomSeries(path()) : findSeriesOfFile(path());
  return &*m_state->dicom;
}

std::optional<std::string> Input::segmentationFile(const InputChoice& choice) const {
  const DicomFolder* const folder = choice.segmentation ? nullptr : dicom();
  if (!folder)
    return choice.segmentation;
  const DicomSeries series = chooseSeries(folder->series, choice.volume, path().string());
  auto found = folder->segmentationsOf(series);
  if (found.size() > 1 && !choice.focus.empty())
    if (auto having = selectByFocus(found, choice.focus); having.size() == 1)
      found = std::move(having);
  if (found.size() > 1)
    throw inputError(ErrorCode::ambiguousSegmentation, path(), "has ", found.size(),
                     " segmentations of this series: ",
                     join(
                         found, ", ", [](const auto& file) { return file.string(); }, 20));
  return found.empty() ? std::nullopt : std::optional(found.front().string());
}

std::vector<Message>
Input::findUnusedSegmentations(const std::optional<std::string>& volume) const {
  constexpr std::size_t mostListed = 3;
  const DicomFolder* const folder = dicom();
  if (!folder)
    return {};
  const auto found = folder->segmentationsOf(chooseSeries(folder->series, volume, path().string()));
  if (found.empty())
    return {};
  return {
      makeMessage(ErrorCode::unusedSegmentation, path(), "has a segmentation that is not used: ",
                  join(
                      found, ", ", [](const auto& file) { return file.string(); }, mostListed))};
}

VolumeHandle Input::volume(const VolumeChoice& choice) const {
  return m_state->isInMemory() ? m_state->volume
                               : std::make_shared<const VolumeInput>(readVolumeInput(choice));
}

VolumeInput Input::readVolumeInput(const VolumeChoice& choice) const {
  if (const DicomFolder* const folder = dicom()) {
    const DicomSeries series = chooseSeries(folder->series, choice.name, path().string());
    return {readDicomVolume(series, choice), toInputFiles(series.files())};
  }
  if (!m_state->isScene && isImageStack(path())) {
    const ImageStack stack = openImageStack(path());
    return {readImageStack(stack, choice), toInputFiles(stack.files())};
  }
  if (!m_state->isScene)
    return {readVolume(path(), choice), {path().string()}};
  return m_state->withScene([&](MrmlScene& scene) {
    Volume volume = readSceneVolume(scene, *makePlan(scene, {choice.name}, false).volume, choice);
    return VolumeInput{std::move(volume), scene.files.usedFiles()};
  });
}

SceneSettings Input::settings(const std::optional<std::string>& volume, bool followsCamera) const {
  if (!m_state->isScene)
    return {};
  return m_state->withScene([&](MrmlScene& scene) {
    const ScenePlan plan = makePlan(scene, {volume}, false);
    SceneSettings settings;
    if (plan.roi)
      settings.crop = readSceneRoi(scene, *plan.roi);
    if (plan.camera && followsCamera)
      settings.camera = readSceneCamera(scene, *plan.camera);
    if (plan.view) {
      const auto [bottom, top] = readViewBackground(*plan.view);
      settings.background = Background::makeGradient(bottom, top);
    }
    settings.warnings = plan.warnings;
    settings.files = scene.files.usedFiles();
    return settings;
  });
}

SceneTransfer Input::transfer(const std::optional<std::string>& volume,
                              const std::array<double, 2>& range) const {
  if (!m_state->isScene)
    return {};
  return m_state->withScene([&](MrmlScene& scene) {
    const ScenePlan plan = makePlan(scene, {volume}, false);
    SceneTransfer result;
    if (plan.sliceDisplay)
      result = {convertSliceDisplay(*plan.rendering, *plan.sliceDisplay, range),
                "the volume's window and level"};
    if (!result.transfer && plan.property)
      result = {readSceneProperty(scene, *plan.property), plan.property->name};
    result.files = scene.files.usedFiles();
    return result;
  });
}

std::optional<SegmentNames> Input::segmentNames(const InputChoice& given) const {
  if (m_state->isInMemory())
    return m_state->segments ? std::optional(SegmentNames{
                                   "segmentation", m_state->segments->segmentation.segments()})
                             : std::nullopt;
  InputChoice choice = given;
  choice.segmentation = segmentationFile(given);
  if (!m_state->isScene)
    return readSegmentNames(choice);
  return m_state->withScene([&](MrmlScene& scene) {
    if (const SegmentationNodes several = findAlternatives(scene, choice); !several.empty())
      return std::optional(readNames(scene, several, choice.labels));
    const bool hasSegmentation = std::ranges::any_of(scene.document.nodes(), isSegmentation);
    const ScenePlan plan = makePlan(scene, choice, hasSegmentation);
    if (!plan.segmentation)
      return readSegmentNames(choice);
    return std::optional(
        SegmentNames{scene.document.source() + ": " + describeNode(*plan.segmentation),
                     readSceneSegmentInfos(scene, *plan.segmentation, choice.labels)});
  });
}

SegmentsHandle Input::segments(const InputChoice& choice, const std::optional<Grid>& volume) const {
  if (m_state->isInMemory() && !m_state->segments)
    throw requestError(ErrorCode::segmentationRequired, "volume", "has no segmentation");
  return m_state->isInMemory() ? m_state->segments
                               : std::make_shared<const SegmentsInput>(
                                     readSegments(choice, volume ? &*volume : nullptr));
}

SegmentsInput Input::readSegments(const InputChoice& given, const Grid* grid) const {
  InputChoice choice = given;
  choice.segmentation = segmentationFile(given);
  const auto readFile = [&] {
    if (!choice.segmentation)
      throw inputError(ErrorCode::segmentationRequired, path(),
                       dicom() ? "has no segmentation that refers to the series"
                               : "has no segmentation, which a focus or materials need");
    Segmentation segmentation = readSegmentation(*choice.segmentation, grid, choice.labels);
    if (const DicomFolder* const folder = dicom())
      segmentation.addWarnings(checkFrameOfReference(
          *choice.segmentation, chooseSeries(folder->series, choice.volume, path().string())));
    return makeSegments(std::move(segmentation), listSegmentationFiles(*choice.segmentation));
  };
  if (!m_state->isScene)
    return readFile();
  return m_state->withScene([&](MrmlScene& scene) {
    if (const auto nodes = findNodesOfFocus(scene, choice); !nodes.empty())
      return makeSegments(readNodes(scene, nodes, grid, choice.labels), scene.files.usedFiles());
    const ScenePlan plan = makePlan(scene, choice, true);
    if (!plan.segmentation && fileExists(*choice.segmentation))
      return readFile();
    if (!plan.segmentation)
      throw inputError(ErrorCode::unknownName, scene.document.source(),
                       "has no segmentation \"" + *choice.segmentation +
                           "\", and no such file exists; fenestra inspect lists the segmentations");
    Segmentation segmentation = readNodes(scene, {plan.segmentation}, grid, choice.labels);
    return makeSegments(std::move(segmentation), scene.files.usedFiles());
  });
}

SceneTransfer Input::property(const std::string& name) const {
  if (!m_state->isScene)
    return {};
  return m_state->withScene([&](MrmlScene& scene) {
    SceneTransfer result;
    for (const MrmlNode* node : scene.document.findByTag("VolumeProperty"))
      if (!result.transfer && (node->name == name || node->id == name))
        result = {readSceneProperty(scene, *node), node->name, scene.files.usedFiles()};
    return result;
  });
}

std::vector<std::string> Input::propertyNames() const {
  const MrmlDocument* scene = document();
  return scene ? fenestra::core::listPropertyNames(*scene) : std::vector<std::string>();
}

} // namespace fenestra::core
