#include "scene/Stages.h"

#include "base/Error.h"
#include "base/TextStream.h"
#include "clip/surface/SteadySurface.h"
#include "files/appearance/LightReader.h"
#include "model/masks/OrganMargin.h"
#include "model/masks/OuterLayer.h"
#include "scene/Defaults.h"
#include "scene/OrganPresets.h"

namespace fenestra::core {
namespace {

constexpr std::array modalities = {"CT", "MR", "ultrasound"}; ///< by Modality

/// Throws Error (input) if the extinction is too large. Because of null collisions, render time is
/// proportional to the largest extinction, so a file could make a render practically endless.
void checkExtinction(const TransferFunction& transfer, const Volume& volume,
                     const std::string& name) {
  constexpr double maxDepth = 1e7; // optical depth across the volume
  double greatest = 0.0;
  for (const auto& knot : transfer.extinction.knots())
    greatest = std::max(greatest, knot.value[0]);
  const double allowed = maxDepth / (2.0 * volume.grid.boundingRadius());
  if (greatest <= allowed)
    return;
  TextWriter line;
  line << "reaches " << greatest << " per mm, but " << allowed
       << " is already opaque in any image of this volume";
  throw inputError(ErrorCode::excessiveExtinction, concat(name, ": extinction"), line.str());
}

/// Focus depths at the viewport's pixels, mm.
std::vector<double> viewportDepths(const FocusDepth& focus, const Camera& camera) {
  std::vector<double> depths;
  for (int row = 0; row < camera.height(); ++row)
    for (int column = 0; column < camera.width(); ++column)
      depths.push_back(focus.depth.at(focus.depth.viewportSample(column, row)));
  return depths;
}

bool hasFrame(LightFrame frame, const Light& light) {
  const auto hasKindFrame = [frame](const auto& kind) {
    if constexpr (requires { kind.frame; })
      return kind.frame == frame;
    else
      return false;
  };
  return std::visit(hasKindFrame, light);
}

bool hasAnyFrame(LightFrame frame, const std::vector<Light>& lights) {
  return std::ranges::any_of(lights, [&](const Light& light) { return hasFrame(frame, light); });
}

/// Mean of the voxel centers, weighted by the indicator, world mm. The focus must not be empty.
Vec3 computeCentroid(const Mask& focus) {
  const Size3& size = focus.grid.size;
  Vec3 moment = Vec3::Zero();
  double weight = 0.0;
  std::size_t i = 0;
  for (std::int64_t z = 0; z < size.z(); ++z)
    for (std::int64_t y = 0; y < size.y(); ++y)
      for (std::int64_t x = 0; x < size.x(); ++x) {
        const double indicator = focus.voxels[i++];
        moment += indicator * Vec3(Size3(x, y, z).cast<double>());
        weight += indicator;
      }
  return focus.grid.indexToWorld * Vec3(moment / weight);
}

/// True for lights that --environment replaces.
bool isEnvironment(const Light& light) {
  return std::holds_alternative<EnvironmentLight>(light) || std::holds_alternative<SkyLight>(light);
}

const Mask* maskOrNull(const FocusHandle& focus) {
  return focus->mask ? &*focus->mask : nullptr;
}

Domain makeDomain(const VolumeHandle& volume, const SettingsHandle& settings) {
  return {volume->volume.grid, settings->crop};
}

/// As chooseTransfer(), before shift and scale.
TransferChoice selectTransfer(const Volume& volume, const Handle<NamedTransfer>& named,
                              const Handle<SceneTransfer>& scene, const ScanContent& content,
                              const std::optional<Modality>& modality) {
  std::vector<Message> warnings;
  if (named && !modality && named->source.starts_with("ct-") &&
      !isPlausibleModality(Modality::ct, volume))
    warnings.push_back(makeMessage(ErrorCode::implausibleModality, named->source,
                                   "the transfer function is for CT, but this volume does not seem "
                                   "to be CT"));
  if (named && (!modality || isPlausibleModality(*modality, volume)))
    return {fitToVolume(named->transfer, volume, content), named->source, warnings, false,
            named->transfer.islands};
  if (named)
    warnings.push_back(makeMessage(
        ErrorCode::implausiblePresetModality, named->source,
        "the preset's transfer function is for ", modalities[static_cast<std::size_t>(*modality)],
        ", which does not seem to be this volume's modality, so a default is used"));
  else if (scene->transfer)
    return {*scene->transfer, scene->name};
  const std::optional<std::string> preset = chooseTransferPreset(volume, content);
  if (!preset)
    return {makeRelativeTransfer(volume), "by the volume's range", warnings};
  const TransferFile file = findTransfer(*preset, Input({})).transfer;
  return {fitToVolume(file, volume, content), *preset, warnings, true, file.islands};
}

/// The requested plane, else a plane fitted to the focus.
ClipPlane placePlane(const ClipRequest& request, const Camera& camera, const FocusHandle& focus,
                     const std::optional<FocusDepth>& depth) {
  if (!request.plane)
    requireVisible(*depth, *maskOrNull(focus));
  ClipPlane plane = request.plane ? ClipPlane{camera, request.plane->origin, request.plane->normal}
                                  : fitFocusPlane(camera, *depth);
  plane.point += request.surface.offset * camera.forward();
  plane.edge = {0.0, request.softness.value_or(0.0)};
  return plane;
}

ClipResult buildPlaneClip(const ClipRequest& request, bool measure, const Domain& domain,
                          const FocusHandle& focus, const Camera& camera) {
  ClipResult result;
  const bool isPlane = request.mode == ClipMode::plane;
  std::optional<FocusDepth> depth;
  if (focus->mask && ((isPlane && !request.plane) || measure)) {
    const Stopwatch watch;
    depth = FocusTracer(camera, domain, *focus->mask).traceDepths();
    result.focusDepth = viewportDepths(*depth, camera);
    result.focusSeconds = watch.seconds();
  }
  if (isPlane)
    result.clip = placePlane(request, camera, focus, depth);
  if (isPlane && depth && measure)
    result.boundary = measureBoundary(result.clip, domain, *focus->mask, *depth);
  return result;
}

ClipResult buildDepthClip(const ClipRequest& request, ClipMode mode, const Domain& domain,
                          const Mask& focus, const Camera& camera, bool measure,
                          double steadyDegrees) {
  SurfaceOptions options = request.surface;
  options.mode = mode == ClipMode::hole      ? SurfaceMode::hole
                 : mode == ClipMode::cutaway ? SurfaceMode::cutaway
                                             : SurfaceMode::surface;
  if (mode == ClipMode::ghost)
    options.edge.ghost = double{static_cast<float>(request.ghost)};
  options.edge.softness =
      request.softness.value_or(mode == ClipMode::ghost ? 0.0 : defaultSoftness);
  ClippingSurface surface = buildSteadySurface(camera, domain, focus, options, steadyDegrees);
  ClipResult result{.clip = std::move(surface.clip),
                    .focusDepth = viewportDepths(surface.focus, camera),
                    .mismatch = surface.mismatch,
                    .controlPoints = std::move(surface.controlPoints),
                    .warnings = std::move(surface.warnings),
                    .focusSeconds = surface.focusSeconds,
                    .splineSeconds = surface.splineSeconds,
                    .fillSeconds = surface.fillSeconds};
  if (measure)
    result.boundary = measureBoundary(result.clip, domain, focus, surface.shown);
  if (options.mode == SurfaceMode::surface && !result.mismatch && result.boundary)
    result.mismatch = result.boundary->gap;
  return result;
}

} // namespace

NamedLights makeLights(const std::string& name, const std::optional<Rgb>& environment,
                       const std::optional<std::filesystem::path>& environmentMap) {
  NamedLights named = findLights(name);
  if (!environment && !environmentMap)
    return named;
  std::erase_if(named.lights, isEnvironment);
  EnvironmentLight replacement;
  if (environment) {
    replacement.radiance = *environment;
  } else {
    replacement.map = readEnvironmentMap(*environmentMap);
    named.files.push_back(environmentMap->string());
  }
  named.lights.emplace_back(replacement);
  return named;
}

namespace {

/// Groups of segments that are adjacent, directly or by others of the group, in a stable order.
std::vector<std::vector<SegmentInfo>> groupAdjacent(const Segmentation& segmentation,
                                                    const std::vector<SegmentInfo>& segments,
                                                    const Grid& volume) {
  struct Group {
    std::vector<SegmentInfo> segments;
    std::vector<Mask> masks;
  };
  std::vector<Group> groups;
  for (const SegmentInfo& segment : segments) {
    Group joined{{segment}, {}};
    joined.masks.push_back(segmentation.makeMask({segment}, volume));
    std::erase_if(groups, [&](Group& group) {
      const bool isAdjacent = std::ranges::any_of(
          group.masks, [&](const Mask& mask) { return areAdjacent(mask, joined.masks.front()); });
      if (isAdjacent) {
        std::ranges::move(group.segments, std::back_inserter(joined.segments));
        std::ranges::move(group.masks, std::back_inserter(joined.masks));
      }
      return isAdjacent;
    });
    groups.push_back(std::move(joined));
  }
  std::vector<std::vector<SegmentInfo>> result;
  for (Group& group : groups)
    result.push_back(std::move(group.segments));
  return result;
}

/// Divides voxels that are too thick for an OrganMargin, if their halves are not. Slices that are
/// much thicker than their pixels are interpolated instead (interpolateSlices).
Handle<SegmentsInput> divideThickVoxels(const Handle<SegmentsInput>& segments) {
  constexpr std::int64_t mostVoxels = 1 << 27; // memory
  const Grid& labels = segments->segmentation.grid();
  const double least = labels.spacing().minCoeff(), greatest = labels.spacing().maxCoeff();
  if (greatest < thickestVoxel || 0.5 * greatest >= thickestVoxel || greatest >= 2.0 * least ||
      8 * labels.voxelCount() > mostVoxels)
    return segments;
  const auto divided = std::make_shared<SegmentsInput>(*segments);
  divided->segmentation.divideVoxels();
  return divided;
}

} // namespace

TrimmedSegments trimSegments(const Handle<SegmentsInput>& segments,
                             const Handle<std::vector<bool>>& hasVoxels,
                             const std::vector<std::string>& names, const VolumeHandle& volume) {
  TrimmedSegments trimmed{segments, {}};
  std::shared_ptr<SegmentsInput> copy;
  const Handle<SegmentsInput> whole = divideThickVoxels(segments);
  const Segmentation& original = whole->segmentation;
  std::vector<SegmentInfo> present;
  for (const std::string& name : names)
    if (const std::size_t number = original.find(name); (*hasVoxels)[number])
      present.push_back(original.segments()[number]);
  for (const auto& group : groupAdjacent(original, present, volume->volume.grid)) {
    const OrganMargin margin =
        findOrganMargin(original.makeMask(group, volume->volume.grid), volume->volume);
    if (margin.volume > 0.0) {
      if (!copy)
        trimmed.input = copy = std::make_shared<SegmentsInput>(*whole);
      for (const SegmentInfo& segment : group)
        copy->segmentation.restrictSegment(segment, margin.kept);
    }
    trimmed.margins.push_back(
        {joinSegmentNames(group), margin.isApplied, margin.volume, margin.mean, margin.p95});
  }
  return trimmed;
}

FocusInput makeFocus(const Handle<SegmentsInput>& segments,
                     const Handle<std::vector<bool>>& hasVoxels,
                     const std::vector<std::string>& names, const MaskShaping& shaping,
                     const Grid& volume) {
  if (names.empty())
    return {};
  const Segmentation& segmentation = segments->segmentation;
  FocusInput focus{segmentation.makeFocusMask(names, volume, shaping)};
  std::vector<SegmentInfo> empty;
  for (const std::string& name : names)
    if (const std::size_t number = segmentation.find(name); !(*hasVoxels)[number])
      empty.push_back(segmentation.segments()[number]);
  if (!empty.empty())
    focus.warnings.push_back(
        makeMessage(ErrorCode::emptyFocus, segmentation.source(),
                    "segments of the focus have no voxel: ", formatSegments(empty)));
  return focus;
}

bool needsContent(const VolumeHandle& volume, const Handle<NamedTransfer>& named,
                  const Handle<SceneTransfer>& scene, const std::optional<Modality>& modality) {
  if (!named)
    return !scene->transfer;
  return named->transfer.scalars == TransferFile::Scalars::tissues ||
         (modality && !isPlausibleModality(*modality, volume->volume));
}

ScanContent findContent(const VolumeHandle& volume, const Handle<SegmentsInput>& segments,
                        const Handle<std::vector<bool>>& hasVoxels,
                        const std::vector<std::string>& focus) {
  return describeScan(volume->volume, segments->segmentation, *hasVoxels, focus);
}

TransferChoice chooseTransfer(const VolumeHandle& read, const Handle<NamedTransfer>& named,
                              const Handle<SceneTransfer>& scene,
                              const Handle<ScanContent>& content,
                              const std::optional<Modality>& modality, double shift, double density,
                              GradientKind gradient) {
  const Volume& volume = read->volume;
  TransferChoice transfer =
      selectTransfer(volume, named, scene, content ? *content : ScanContent(), modality);
  transfer.function = transfer.function.withShift(shift).withDensity(density);
  transfer.function.gradient = gradient;
  checkExtinction(transfer.function, volume, named ? transfer.source : volume.name);
  if (transfer.function.shading && volume.minimum == volume.maximum)
    throw inputError(ErrorCode::uniformVolume, volume.name,
                     "all voxels have the same value, so gradients for surface shading are zero; "
                     "use a transfer function with shading off (\"shading\": \"volume\")");
  return transfer;
}

std::vector<Message> checkFocus(const VolumeHandle& volume, const FocusHandle& focus,
                                const Handle<TransferChoice>& transfer) {
  if (!focus->mask)
    return {};
  const double fraction = transparentFraction(*focus->mask, volume->volume, transfer->function);
  if (fraction <= mostTransparent)
    return {};
  return {makeMessage(ErrorCode::transparentFocus, transfer->source, "the transfer function makes ",
                      std::lround(100.0 * fraction), " % of the focus transparent")};
}

ViewDirection chooseView(const VolumeHandle& volume, const SettingsHandle& settings,
                         const FocusHandle& focus, const Handle<TransferChoice>& transfer) {
  return findBestView(
      ViewScorer(volume->volume, makeDomain(volume, settings), transfer->function, *focus->mask));
}

Box findOccupiedBounds(const VolumeHandle& volume, const Handle<MinMaxGrid>& minMax,
                       const Handle<TransferChoice>& transfer) {
  return MajorantGrid(volume->volume.grid, *minMax, transfer->function, ClipNone())
      .occupiedBounds();
}

Camera placeCamera(const ViewRequest& view, int width, int height, const VolumeHandle& volume,
                   const SettingsHandle& settings, const Box& bounds, const FocusHandle& focus,
                   const Handle<ViewDirection>& best) {
  if (settings->camera)
    return {adjustView(view, *settings->camera), width, height};
  const Domain domain = makeDomain(volume, settings);
  const Domain occupied = domain.intersect(bounds);
  const Domain& framed = occupied.indexCorners().empty() ? domain : occupied;
  return {frameView(view, framed, maskOrNull(focus), width, height, best.get()), width, height};
}

bool FramedLights::operator==(const FramedLights& other) const {
  return lights == other.lights &&
         (camera == other.camera || !hasAnyFrame(LightFrame::camera, lights->lights)) &&
         (focus == other.focus || !hasAnyFrame(LightFrame::focus, lights->lights));
}

LightSet placeLights(const FramedLights& framed, const VolumeHandle& volume) {
  const std::vector<Light>& lights = framed.lights->lights;
  const Grid& grid = volume->volume.grid;
  if (!hasAnyFrame(LightFrame::focus, lights))
    return {lights, grid, *framed.camera};
  if (const Mask* const focus = maskOrNull(framed.focus))
    return {lights, grid, *framed.camera, computeCentroid(*focus)};
  const auto first = std::ranges::find_if(
      lights, [](const Light& light) { return hasFrame(LightFrame::focus, light); });
  throw inputError(ErrorCode::focusRequired,
                   concat(framed.lights->source, ": lights[", first - lights.begin(), "].frame"),
                   "is \"focus\", but there is no focus");
}

ClipResult buildClip(const ClipRequest& request, bool measure, double steadyDegrees,
                     const VolumeHandle& volume, const SettingsHandle& settings,
                     const FocusHandle& focus, const Handle<Camera>& camera) {
  const Domain domain = makeDomain(volume, settings);
  const ClipMode mode = request.resolveMode(focus->mask.has_value());
  if (isDepthClip(mode))
    return buildDepthClip(request, mode, domain, *focus->mask, *camera, measure, steadyDegrees);
  return buildPlaneClip(request, measure, domain, focus, *camera);
}

MinMaxGrid makeMinMaxGrid(const VolumeHandle& volume, int padding) {
  return {volume->volume, padding};
}

Mask findSkin(const VolumeHandle& volume) {
  constexpr double depth = 2.5; // mm
  const std::optional<double> air = findAirThreshold(volume->volume);
  return air ? findOuterLayer(volume->volume, *air, depth) : Mask();
}

TintInterfaces findTintInterfaces(const VolumeHandle& volume, const FocusHandle& focus,
                                  const Handle<TransferChoice>& transfer,
                                  const Handle<LabelWeights>& weights,
                                  const std::vector<bool>& isFocus) {
  return findInterfaces(*focus->mask, volume->volume, transfer->function, *weights, isFocus);
}

TintContrast adjustTintContrast(const Handle<TintInterfaces>& interfaces,
                                const Handle<TintPlan>& plan, const Handle<Tint>& tint,
                                const Handle<NamedMaterials>& materials,
                                const Handle<TransferChoice>& transfer) {
  return adjustContrast(*interfaces, *plan, *tint, materials->table, transfer->function);
}

Mixture makeMixture(const Handle<TintPlan>& plan, const Handle<Tint>& tint,
                    const Handle<TransferChoice>& transfer) {
  return buildMixture(*plan, *tint, transfer->function);
}

Tint adjustTint(const Handle<Tint>& tint, const Handle<TintPlan>& plan,
                const Handle<TintContrast>& contrast, const Handle<TransferChoice>& transfer) {
  return applyAdjustment(*tint, *plan, contrast->adjustment, transfer->function);
}

FocusContrast chooseContrast(const VolumeHandle& volume, const FocusHandle& focus,
                             const Handle<TransferChoice>& transfer, const Handle<Tint>& tint,
                             const std::optional<double>& saturation) {
  if (tint || !focus->mask)
    return {};
  return measureFocusContrast(saturation.value_or(defaultContextSaturation), *focus->mask,
                              volume->volume, transfer->function);
}

ContextStyle makeContextStyle(const FocusHandle& focus, double extinction, double saturation) {
  return {{focus, &*focus->mask}, extinction, saturation};
}

ExtinctionBounds boundExtinction(const VolumeHandle& volume, const Handle<MinMaxGrid>& minMax,
                                 const Handle<TransferChoice>& transfer,
                                 const Handle<Mixture>& mixture) {
  return {volume->volume.grid, *minMax, transfer->function, mixture.get()};
}

MajorantGrid buildMajorants(const Handle<ExtinctionBounds>& bounds, const Handle<ClipResult>& clip,
                            const Handle<ContextStyle>& style) {
  return {*bounds, clip->clip, style.get()};
}

FeatureBuffers marchFirstHits(const VolumeHandle& volume, const SettingsHandle& settings,
                              const Handle<TransferChoice>& transfer, const TintOrMixture& segments,
                              const Handle<LightSet>& lights, const Handle<Camera>& camera,
                              const Handle<ClipResult>& clip, const Handle<ContextStyle>& style,
                              const Handle<MajorantGrid>& majorants, FeatureEffort effort,
                              const StageStop& stop) {
  FeatureBuffers features =
      computeFeatures({volume->volume, transfer->function, *majorants, *lights, *camera, clip->clip,
                       settings->crop, style.get(), segments.tint.get(), segments.mixture.get()},
                      effort, *stop.flag);
  requireRunning(*stop.flag);
  return features;
}

} // namespace fenestra::core
