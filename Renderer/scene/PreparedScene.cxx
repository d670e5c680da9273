#include "scene/PreparedScene.h"

#include "base/Text.h"
#include "scene/Defaults.h"
#include "scene/SegmentMaterials.h"

#include <algorithm>
#include <array>

namespace fenestra::core {
namespace {

template <typename Item>
void append(const std::vector<Item>& from, std::vector<Item>& to) {
  to.insert(to.end(), from.begin(), from.end());
}

std::string describeSmoothing(const Mask& focus, const Vec3& native) {
  const auto width = [&](int axis) { return toString(native[axis], 3); };
  const double percent = std::round(1e3 * focus.volumeChange) / 10.0 + 0.0; // no -0
  return concat("segments smoothed by ", toString(focus.smoothing, 3),
                " mm (label map made on voxels of ", width(0), " x ", width(1), " x ", width(2),
                " mm); volume of the focus ", percent < 0.0 ? "" : "+", toString(percent, 3), " %");
}

/// Throws a warning about what a reader assumed as an Error (input).
void refuseAssumptions(const std::vector<Message>& warnings) {
  using enum ErrorCode;
  constexpr std::array assumptions = {
      assumedForm,        assumedFrame,  assumedGeometry,        assumedUnits,
      interpolatedSlices, omittedSlices, removedHounsfieldOffset};
  for (const Message& warning : warnings)
    if (std::ranges::find(assumptions, warning.code) != assumptions.end())
      throw Error(ErrorKind::input, warning);
}

} // namespace

PreparedScene::PreparedScene(const RenderRequest& request)
    : PreparedScene(request, Input(request.input)) {}

PreparedScene::PreparedScene(const RenderRequest& request, const Input& input, const StopFlag& stop)
    : m_request(request), m_input(input) {
  prepare(stop);
}

PreparedScene PreparedScene::withRequest(const RenderRequest& request, const StopFlag& stop,
                                         const PreparedScene* sameSize) const {
  PreparedScene scene = *this;
  scene.m_request = request;
  if (sameSize) {
    scene.m_camera = sameSize->m_camera;
    scene.m_lights = sameSize->m_lights;
    scene.m_clip = sameSize->m_clip;
    scene.m_majorants = sameSize->m_majorants;
    scene.m_features = sameSize->m_features;
  }
  if (request.input != m_input.path())
    scene.m_input = Input(request.input);
  scene.prepare(stop);
  return scene;
}

void PreparedScene::readInput() {
  const RenderRequest& r = m_request;
  if (!needsLungs(r)) // which may change the default lights
    m_namedLights.get(r.lightsName(), r.environment, r.environmentMap); // fails early
  if (r.transfer)
    m_namedTransfer.get(*r.transfer, m_input);
  const auto read = m_volume.get(m_input, *m_volumeChoice.get(m_input, r.volume, r.segmentation));
  if (r.isStrict)
    refuseAssumptions(read->volume.warnings);
  if (needsLungs(r) && m_lungs.get(read)->input)
    m_request.focus = {lungSegment};
  m_settings.get(m_input, r.volume.name, r.view.isSceneCamera());
  if (!allSegments() && (r.materials.value_or(noMaterials) != noMaterials || !r.focus.empty()))
    m_segments.get(m_input, chooseSegmentation(), read->volume.grid);
  if (r.isStrict && allSegments())
    refuseAssumptions(allSegments()->segmentation.warnings());
  if (r.table != TableRequest::keep)
    m_table.get(read, r.table);
  if (m_table.result() && m_table->table)
    m_withoutTable.get(read, m_table.result(), allSegments(),
                       allSegments() ? m_hasVoxels.get(allSegments())
                                     : Handle<std::vector<bool>>());
}

void PreparedScene::prepareFocus() {
  const RenderRequest& r = m_request;
  const VolumeHandle raw = rawVolume();
  if (r.focusStyle.hasOrganMargin && !r.focus.empty() &&
      isPlausibleModality(Modality::ct, raw->volume))
    m_trimmed.get(allSegments(), m_hasVoxels.get(allSegments()), r.focus, raw);
  if (!r.focus.empty())
    m_hasVoxels.get(allSegments());
  m_focus.get(currentSegments(), m_hasVoxels.result(), r.focus, r.focusStyle.shaping,
              raw->volume.grid);
}

PreparedScene::Focus PreparedScene::readFocus(const RenderRequest& request, const Input& input) {
  PreparedScene scene(request, input, Unprepared());
  scene.readInput();
  scene.prepareFocus();
  return {scene.m_focus.result(), scene.rawVolume()->volume.grid, scene.inputWarnings()};
}

void PreparedScene::prepare(const StopFlag& stop) {
  const RenderRequest& r = m_request;
  std::apply([](auto&... stage) { (stage.markUnused(), ...); }, stages(*this));
  readInput();
  requireRunning(stop);
  const auto lights = m_namedLights.get(r.lightsName(), r.environment, r.environmentMap);
  const auto settings = m_settings.result();
  const VolumeHandle raw = rawVolume();
  prepareFocus();
  const auto focus = m_focus.result();
  if (!r.transfer)
    m_sceneTransfer.get(m_input, r.volume.name, {raw->volume.minimum, raw->volume.maximum});
  if (allSegments() &&
      needsContent(raw, m_namedTransfer.result(), m_sceneTransfer.result(), r.transferModality))
    m_content.get(raw, allSegments(), m_hasVoxels.get(allSegments()), r.focus);
  const auto transfer =
      m_transfer.get(raw, m_namedTransfer.result(), m_sceneTransfer.result(), m_content.result(),
                     r.transferModality, r.shift, r.density, r.gradient);
  requireRunning(stop);
  const VolumeHandle volume = smooth(stop);
  requireRunning(stop);
  if (const std::string name = resolveMaterials(allSegments()); name != noMaterials) {
    makeTint(name, stop);
    if (!isTintOnly(*m_plan))
      m_mixture.get(m_plan.result(), currentTint(), transfer);
  }
  if (!hasSolidFocus() && !m_lungs.result()) // the spaces in lungs are transparent
    m_focusWarnings.get(volume, focus, transfer);
  if (r.view.isAutomatic() && focus->mask)
    m_view.get(raw, settings, focus, transfer);
  const auto minMaxGrid =
      m_minMaxGrid.get(volume, MajorantGrid::requiredPadding(transfer->function));
  Box bounds;
  if (!settings->camera) { // by the raw volume: requests with other outputs show the same frame
    const auto rawMinMax =
        volume == raw ? minMaxGrid : m_rawMinMaxGrid.get(raw, minMaxGrid->padding());
    bounds = *m_occupiedBounds.get(raw, rawMinMax, transfer);
  }
  const auto camera =
      m_camera.get(r.view, r.width, r.height, raw, settings, bounds, focus, m_view.result());
  requireRunning(stop);
  const auto placed = m_lights.get({lights, camera, focus}, raw);
  const auto clip = m_clip.get(r.clip, r.measure, r.steadyDegrees, raw, settings, focus, camera);
  const double extinction = r.focusStyle.contextExtinction;
  const double saturation =
      m_contrast.get(volume, focus, transfer, currentTint(), r.focusStyle.contextSaturation)
          ->saturation;
  if (focus->mask && (extinction != 1.0 || saturation != 1.0))
    m_style.get(focus, extinction, saturation);
  const auto majorants = m_majorants.get(
      m_bounds.get(volume, minMaxGrid, transfer, m_mixture.result()), clip, m_style.result());
  requireRunning(stop);
  if (r.features)
    m_features.get(volume, settings, transfer, tintOrMixture(), placed, camera, clip,
                   m_style.result(), majorants,
                   r.isDraft ? FeatureEffort::draft : FeatureEffort::full, {&stop});
}

InputChoice PreparedScene::chooseSegmentation() const {
  const RenderRequest& r = m_request;
  InputChoice choice{r.volume.name, r.segmentation, r.labels};
  if (!r.segmentation && m_input.hasSeveralSegmentations()) // else another focus reads nothing
    choice.focus = r.focus;
  return choice;
}

VolumeHandle PreparedScene::smooth(const StopFlag& stop) {
  const RenderRequest& r = m_request;
  if (r.smoothing.kind == SmoothingRequest::Kind::off)
    return rawVolume();
  const Modality modality = findModality(m_volume->volume, r.transferModality, m_transfer->source);
  if (r.isDraft && !m_smoothed.isCached(rawVolume(), r.smoothing, modality, {&stop}))
    return rawVolume();
  const auto smoothed = m_smoothed.get(rawVolume(), r.smoothing, modality, {&stop});
  if (smoothed->input && m_transfer->islands)
    m_islands.get(currentVolume(), m_transfer.result(), m_focus.result());
  return currentVolume();
}

VolumeHandle PreparedScene::currentVolume() const {
  for (const auto& stage : {m_islands.result(), m_smoothed.result()})
    if (stage && stage->input)
      return {stage, &*stage->input};
  return rawVolume();
}

VolumeHandle PreparedScene::rawVolume() const {
  return m_withoutTable.result() ? m_withoutTable.result() : m_volume.result();
}

std::optional<SmoothingReport> PreparedScene::smoothing() const {
  if (!m_smoothed.result())
    return std::nullopt;
  SmoothingReport report = m_smoothed->report;
  if (m_islands.result()) {
    report.islands = m_islands->report.islands;
    report.islandVolume = m_islands->report.islandVolume;
  }
  return report;
}

std::string PreparedScene::resolveMaterials(const Handle<SegmentsInput>& segments) const {
  const RenderRequest& r = m_request;
  if (r.materials)
    return *r.materials;
  // One color per segment would hide the signal inside an organ, which is what MR shows; and
  // found lungs are seen by their vessels.
  const bool isTissue = isPlausibleModality(Modality::ct, m_volume->volume);
  const bool isDefault = isTissue && !r.focus.empty() && !m_lungs.result();
  return isDefault && hasKnownMaterial(segments->segmentation, r.focus) ? libraryMaterials
                                                                        : noMaterials;
}

void PreparedScene::makeTint(const std::string& name, const StopFlag& stop) {
  const RenderRequest& r = m_request;
  std::optional<double> saturation = r.focusStyle.contextSaturation;
  if (!saturation && name == libraryMaterials && !r.focus.empty())
    saturation = defaultContextSaturation;
  const auto materials = m_materials.get(name, saturation);
  const bool isAdjusted = materials->hasColorAdjustment();
  const auto hasVoxels = m_hasVoxels.get(allSegments());
  if (materials->table.detectsSkin)
    m_skin.get(currentVolume());
  if (isAdjusted && m_transfer->isByModality)
    m_transparent.get(currentSegments(), hasVoxels, r.focus, rawVolume(), m_transfer.result());
  const auto plan = m_plan.get(allSegments(), hasVoxels, materials, r.materialChanges,
                               isAdjusted ? r.focus : std::vector<std::string>(), m_skin.result(),
                               m_transparent.result());
  const auto segments =
      hasSolidFocus() ? m_separated.get(currentSegments(), m_transparent.result(), rawVolume())
                      : currentSegments();
  const auto& smoothing = r.focusStyle.shaping.smoothing;
  const Handle<Mask> skin = m_skin.result();
  const bool isSmoothed = !r.isDraft || m_labelWeights.isCached(segments, plan->parts, skin,
                                                                smoothing, volume().grid, {&stop});
  const auto weights =
      m_labelWeights.get(segments, plan->parts, skin, isSmoothed ? smoothing : std::optional(0.0),
                         volume().grid, {&stop});
  const auto transfer = m_transfer.result();
  const auto tint = m_tint.get(plan, weights, transfer->function.g);
  if (!isAdjusted || !focus())
    return;
  const auto interfaces =
      m_interfaces.get(currentVolume(), m_focus.result(), transfer, weights, plan->isFocus);
  const auto contrast = m_tintContrast.get(interfaces, plan, tint, materials, transfer);
  m_adjustedTint.get(tint, plan, contrast, transfer);
}

StageSeconds PreparedScene::seconds() const {
  const ClipResult unused, &clip = m_clip.isUpdated() ? *m_clip : unused; // unused: 0 seconds
  return {.load = m_namedTransfer.seconds() + m_volumeChoice.seconds() + m_volume.seconds() +
                  m_table.seconds() + m_withoutTable.seconds() + m_settings.seconds() +
                  m_segments.seconds() + m_trimmed.seconds() + m_focus.seconds() +
                  m_sceneTransfer.seconds() + m_hasVoxels.seconds() + m_content.seconds() +
                  m_transfer.seconds(),
          .smoothing = m_smoothed.seconds() + m_islands.seconds(),
          .materials = m_materials.seconds() + m_transparent.seconds() + m_separated.seconds() +
                       m_plan.seconds() + m_skin.seconds() + m_labelWeights.seconds() +
                       m_tint.seconds() + m_interfaces.seconds() + m_tintContrast.seconds() +
                       m_adjustedTint.seconds() + m_mixture.seconds(),
          .classify = m_minMaxGrid.seconds() + m_rawMinMaxGrid.seconds() +
                      m_occupiedBounds.seconds() + m_contrast.seconds() + m_style.seconds() +
                      m_bounds.seconds() + m_majorants.seconds(),
          .focus = clip.focusSeconds,
          .spline = clip.splineSeconds,
          .fill = clip.fillSeconds,
          .features = m_features.seconds()};
}

UpdatedStages PreparedScene::updatedStages() const {
  return {m_volume.isUpdated() || m_withoutTable.isUpdated() || m_smoothed.isUpdated() ||
              m_islands.isUpdated(),
          m_focus.isUpdated(),
          m_transfer.isUpdated(),
          m_camera.isUpdated(),
          m_lights.isUpdated(),
          m_clip.isUpdated(),
          m_minMaxGrid.isUpdated(),
          m_majorants.isUpdated(),
          m_tint.isUpdated() || m_adjustedTint.isUpdated(),
          m_labelWeights.isUpdated()};
}

std::vector<std::string> PreparedScene::choices() const {
  const RenderRequest& r = m_request;
  const char* const from = r.transferModality         ? " (by the preset)"
                           : m_transfer->isByModality ? " (by modality)"
                                                      : "";
  std::vector<std::string> facts = {concat("transfer function: ", transferName(), from)};
  const auto report = smoothing();
  facts.push_back("volume: " + (report ? describe(*report) : "as read, not smoothed"));
  if (r.environment || r.environmentMap)
    facts.emplace_back("lights: environment");
  else
    facts.push_back("lights: " +
                    (r.lights && r.lights->starts_with('{') ? "inline JSON" : r.lightsName()));
  if (allSegments() && !allSegments()->segmentation.namesSource().empty())
    facts.push_back("names of segments: " + allSegments()->segmentation.namesSource());
  if (m_lungs.result() && m_lungs->input)
    facts.push_back(concat("focus: lungs found in the volume, ", toString(m_lungs->volume / 1e6, 2),
                           " l with their vessels"));
  for (const SegmentMargin& margin : margins())
    facts.push_back(margin.isApplied
                        ? concat("margin of ", margin.segment, ": mean ", toString(margin.mean, 2),
                                 " mm, p95 ", toString(margin.p95, 2), " mm, removes ",
                                 toString(margin.volume / 1000.0, 3), " ml of other tissue")
                        : concat("margin of ", margin.segment,
                                 ": none (too small, voxels too thick, or not of one tissue)"));
  if (m_focus->mask && m_focus->mask->smoothing > 0.0)
    facts.push_back(describeSmoothing(*m_focus->mask, nativeSpacing()));
  if (tint()) {
    const std::size_t colors = tint()->albedo.size() - 1;
    facts.push_back(concat("materials: ", m_materials->source, ", ", colors,
                           colors == 1 ? " color" : " colors",
                           m_plan->hasDetectedSkin() ? ", skin detected" : "",
                           hasSolidFocus() ? ", focus as a solid body" : ""));
  }
  const double softness = std::visit([](const auto& kind) { return kind.edge.softness; }, clip());
  if (softness > 0.0)
    facts.push_back(concat("cut softened over ", toString(softness, 3), " mm"));
  if (const std::string text = tintContrast() ? summary(*tintContrast()) : summary(contrast());
      !text.empty())
    facts.push_back(text);
  return facts;
}

std::vector<Message> PreparedScene::inputWarnings() const {
  std::vector<Message> warnings = m_request.omissions;
  append(volume().warnings, warnings);
  if (m_table.result())
    append(m_table->warnings, warnings);
  append(m_settings->warnings, warnings);
  append(allSegments() ? allSegments()->segmentation.warnings()
                       : m_input.findUnusedSegmentations(m_request.volume.name),
         warnings);
  if (m_lungs.result())
    append(m_lungs->warnings, warnings);
  append(m_focus->warnings, warnings);
  return warnings;
}

std::vector<Message> PreparedScene::warnings() const {
  std::vector<Message> warnings = inputWarnings();
  append(m_transfer->warnings, warnings);
  if (m_focusWarnings.result())
    append(*m_focusWarnings, warnings);
  if (domain().indexCorners().empty())
    warnings.push_back(makeMessage(ErrorCode::emptyCrop, "crop box",
                                   "lies outside the volume, so the image is empty"));
  append(m_clip->warnings, warnings);
  if (m_smoothed.result())
    append(m_smoothed->warnings, warnings);
  return warnings;
}

std::vector<std::string> PreparedScene::files() const {
  std::vector<std::string> files;
  const auto add = [&files](const auto& stage) {
    if constexpr (requires { stage->files; })
      if (stage.result())
        append(stage->files, files);
  };
  std::apply([&](const auto&... stage) { (add(stage), ...); }, stages(*this));
  std::ranges::sort(files);
  files.erase(std::unique(files.begin(), files.end()), files.end());
  return files;
}

} // namespace fenestra::core
