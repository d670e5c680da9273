#include "scene/SegmentTint.h"

#include "base/Error.h"
#include "model/masks/OuterLayer.h"
#include "model/medium/Reflectance.h"
#include "scene/SegmentMaterials.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <tuple>

namespace fenestra::core {
namespace {

constexpr std::size_t maxComponents = 256; ///< a component index is one byte
constexpr const char* skinMaterial = "skin";
constexpr int skinPriority = 1;

/// Makes a tint a solid body. Its color is constant: that of the scalars at its surface, which are
/// partial volume, would show the slices.
void makeSolid(Material& material, double scalar) {
  constexpr double solidExtinction = 3.0; // mm^-1, as soft tissue
  material.kind = MaterialKind::medium;
  material.color = ColorFunction({{0.0, (*material.color)(scalar)}});
  material.extinction = ScalarFunction({{0.0, ScalarFunction::Value(solidExtinction)}});
}

/// Material of each segment after the changes. Around a focus whose colors are adjusted, segments
/// have no palette colors, which would be the most vivid of the image.
std::vector<SegmentMaterial> collectMaterials(const Segmentation& segmentation,
                                              const NamedMaterials& materials,
                                              const TransparentFocus& transparent,
                                              const std::vector<std::string>& changes) {
  const std::vector<SegmentInfo>& segments = segmentation.segments();
  std::vector<SegmentMaterial> all = assignMaterials(segments, materials.table);
  if (materials.hasColorAdjustment())
    for (SegmentMaterial& material : all)
      if (material.isFromPalette)
        material.medium.material = {};
  for (const auto& [segment, median] : transparent)
    if (Material& material = all[segment].medium.material;
        material.color && material.kind == MaterialKind::tint)
      makeSolid(material, median);
  for (const std::string& text : changes) {
    const MaterialChange change = parseMaterialChange(text, materials.table);
    const std::size_t i = segmentation.find(change.selector);
    all[i].medium = applyChange(all[i].medium, change, materials.table);
  }
  return all;
}

/// Indices of the segments sorted by name, then id. Components are numbered in this order, so that
/// images do not depend on the order in a file.
std::vector<std::size_t> sortByName(const std::vector<SegmentInfo>& segments) {
  std::vector<std::size_t> indices(segments.size());
  std::iota(indices.begin(), indices.end(), std::size_t{0});
  std::ranges::stable_sort(
      indices, {}, [&](std::size_t i) { return std::tie(segments[i].name, segments[i].id); });
  return indices;
}

/// Material outside all segments.
Material unlabeledMaterial(const NamedMaterials& materials) {
  const MaterialTable& table = materials.table;
  return table.rest.empty() ? Material() : table.materials.at(table.rest);
}

/// True if a non-empty segment is skin.
bool hasSkin(const std::vector<SegmentMaterial>& all, const std::vector<bool>& hasVoxels) {
  for (std::size_t i = 0; i < all.size(); ++i)
    if (hasVoxels[i] && all[i].name == skinMaterial)
      return true;
  return false;
}

/// True if both media are equal under any transfer function; ignores priority.
bool isSame(const SegmentMedium& a, const SegmentMedium& b) {
  const Material &m = a.material, &n = b.material;
  const bool isSameColor = m.color == n.color && (!m.color || m.colorIsAlbedo == n.colorIsAlbedo);
  if (!isSameColor || m.kind != n.kind || a.isClipped != b.isClipped || a.density != b.density)
    return false;
  return m.kind == MaterialKind::tint ||
         (m.extinction == n.extinction &&
          std::tie(m.g, m.diffuse, m.specular, m.roughness, m.interfaceWeight) ==
              std::tie(n.g, n.diffuse, n.specular, n.roughness, n.interfaceWeight));
}

/// Index of the component with this medium; adds one if needed. `segment`: the segment's name.
std::uint8_t findComponent(const SegmentMaterial& material, const std::string& segment,
                           bool isFocus, TintPlan& plan, const std::string& source) {
  const std::string& name = material.name.empty() ? segment : material.name;
  for (std::size_t i = 0; i < plan.components.size(); ++i)
    if (plan.isFocus[i] == isFocus && isSame(material.medium, plan.components[i])) {
      if (i > 0)
        plan.names[i] = name;
      return static_cast<std::uint8_t>(i);
    }
  if (plan.components.size() == maxComponents)
    throw inputError(ErrorCode::tooManyMaterials, source, "its segments have more than ",
                     maxComponents - 1, " materials");
  plan.components.push_back(material.medium);
  plan.names.push_back(segment);
  plan.isFocus.push_back(isFocus);
  return static_cast<std::uint8_t>(plan.components.size() - 1);
}

/// Flags the segments of the focus; all false if the materials do not adjust its colors.
std::vector<bool> markFocus(const Segmentation& segmentation, const NamedMaterials& materials,
                            const std::vector<std::string>& focus) {
  const ContextColors& context = materials.table.context;
  if (focus.empty() && (context.saturation || context.lightness))
    throw inputError(ErrorCode::focusRequired, concat(materials.source, ": context"),
                     "needs a focus");
  std::vector<bool> isFocus(segmentation.segments().size());
  if (materials.hasColorAdjustment())
    for (const std::string& selector : focus)
      isFocus[segmentation.find(selector)] = true;
  return isFocus;
}

/// True if no voxel can belong to both parts: all their segments are in one layer.
bool areExclusive(const TintPart& a, const TintPart& b, const std::vector<SegmentInfo>& segments) {
  if (a.segments.empty() || b.segments.empty())
    return false;
  const std::size_t layer = segments[a.segments.front()].layer;
  const auto isThere = [&](std::size_t i) { return segments[i].layer == layer; };
  return std::ranges::all_of(a.segments, isThere) && std::ranges::all_of(b.segments, isThere);
}

/// Raises the priority of the focus to that of the parts that it excludes. Smoothed parts of higher
/// priority, such as a vein on a vertebra, would otherwise color its surface.
void raiseFocus(std::vector<TintPart>& parts, const std::vector<SegmentInfo>& segments) {
  for (TintPart& focus : parts)
    if (focus.isFocus)
      for (const TintPart& part : parts)
        if (!part.isFocus && areExclusive(focus, part, segments))
          focus.priority = std::max(focus.priority, part.priority);
}

/// Removes parts of component 0 with lower priority than all others: they cover nothing.
std::vector<TintPart> removeRedundant(std::vector<TintPart> parts) {
  const auto isColored = [](const TintPart& part) { return part.component != 0; };
  int lowest = std::numeric_limits<int>::max();
  for (const TintPart& part : parts)
    if (isColored(part))
      lowest = std::min(lowest, part.priority);
  if (std::ranges::any_of(parts, isColored))
    std::erase_if(parts,
                  [&](const TintPart& part) { return !isColored(part) && part.priority < lowest; });
  return parts;
}

/// Applies all properties of a material except its color. The component starts as a copy of the
/// volume's medium; the albedo is recomputed for the material's mean cosine.
void applyMaterial(const Material& material, Component& component) {
  TransferFunction& transfer = component.transfer;
  if (!material.colorIsAlbedo)
    transfer.albedo = transfer.albedo.withKnots([&](ColorFunction::Knot& knot) {
      knot.value = toAlbedo(toReflectance(Rgb(knot.value), transfer.g), material.g);
    });
  transfer.g = material.g;
  if (material.extinction) {
    transfer.extinction = *material.extinction;
    transfer.gradientOpacity.reset();
  }
  if (transfer.shading) {
    const double gamma = transfer.shading->gamma;
    transfer.shading =
        SurfaceShading::makeCoated(material.specular, material.roughness, material.g);
    transfer.shading->diffuse = material.diffuse;
    transfer.shading->gamma = gamma;
  }
  component.interfaceWeight = material.interfaceWeight;
}

} // namespace

std::vector<bool> findNonEmpty(const Handle<SegmentsInput>& input) {
  std::vector<bool> hasVoxels;
  for (const SegmentStatistics& segment : input->segmentation.statistics())
    hasVoxels.push_back(segment.voxels > 0);
  return hasVoxels;
}

TintPlan makeTintPlan(const Handle<SegmentsInput>& input,
                      const Handle<std::vector<bool>>& hasVoxels,
                      const Handle<NamedMaterials>& materials,
                      const std::vector<std::string>& changes,
                      const std::vector<std::string>& focus, const Handle<Mask>& skin,
                      const Handle<TransparentFocus>& transparent) {
  const Segmentation& segmentation = input->segmentation;
  const std::vector<SegmentMaterial> all = collectMaterials(
      segmentation, *materials, transparent ? *transparent : TransparentFocus(), changes);
  const std::vector<bool> isFocus = markFocus(segmentation, *materials, focus);
  TintPlan plan{.parts = {},
                .components = {{unlabeledMaterial(*materials)}},
                .names = {"the rest"},
                .isFocus = {false}};
  std::map<std::pair<std::uint8_t, int>, std::vector<std::size_t>> segments;
  for (const std::size_t i : sortByName(segmentation.segments()))
    if ((*hasVoxels)[i]) {
      const std::uint8_t component = findComponent(all[i], segmentation.segments()[i].name,
                                                   isFocus[i], plan, segmentation.source());
      segments[{component, all[i].medium.priority}].push_back(i);
    }
  const bool canPrecede = isTintOnly(plan); // media stay inside their segments
  for (auto& [key, indices] : segments) {
    const auto& [component, priority] = key;
    plan.parts.push_back(
        {std::move(indices), priority, component, canPrecede && plan.isFocus[component]});
  }
  raiseFocus(plan.parts, segmentation.segments());
  if (skin && skin->count > 0 && !hasSkin(all, *hasVoxels)) {
    const Material& material = materials->table.materials.at(skinMaterial);
    const std::uint8_t component =
        findComponent({{material}, skinMaterial}, skinMaterial, false, plan, segmentation.source());
    plan.parts.push_back({{}, skinPriority, component});
  }
  plan.parts = removeRedundant(std::move(plan.parts));
  if (plan.parts.empty())
    throw inputError(ErrorCode::noVoxelToColor, segmentation.source(),
                     "no segment has a voxel, so nothing can be colored");
  return plan;
}

LabelWeights computeLabelWeights(const Handle<SegmentsInput>& input,
                                 const std::vector<TintPart>& parts, const Handle<Mask>& skin,
                                 const std::optional<double>& smoothing, const Grid& volume,
                                 const StageStop& stop) {
  const Segmentation& segmentation = input->segmentation;
  std::optional<Grid> labels; // of the preceding parts
  const auto partAt = [&](std::size_t number) -> LabelWeights::Part {
    requireRunning(*stop.flag);
    const TintPart& part = parts[number];
    // Smoothed parts overlap: a neighbor of equal priority would color part of the focus's surface.
    const int priority = 2 * part.priority + (part.isFocus ? 1 : 0);
    if (part.segments.empty())
      return {resampleMask(*skin, labels.value_or(skin->grid), volume), priority, part.component};
    std::vector<SegmentInfo> segments;
    for (const std::size_t i : part.segments)
      segments.push_back(segmentation.segments()[i]);
    Mask mask = segmentation.makeMask(segments, volume, {.margins = {}, .smoothing = smoothing});
    labels = mask.grid;
    return {std::move(mask), priority, part.component};
  };
  return {parts.size(), partAt};
}

Tint buildTint(const Handle<TintPlan>& plan, const Handle<LabelWeights>& weights, double g) {
  Tint tint{weights, {}};
  for (const SegmentMedium& component : plan->components) {
    const std::optional<ColorFunction>& color = component.material.color;
    const bool isAlbedo = component.material.colorIsAlbedo;
    tint.albedo.push_back(!color || isAlbedo ? color : std::optional(toAlbedo(*color, g)));
  }
  return tint;
}

bool isTintOnly(const TintPlan& plan) {
  return std::ranges::all_of(plan.components, [](const SegmentMedium& component) {
    return component.material.kind == MaterialKind::tint && component.isClipped &&
           component.density == 1.0;
  });
}

Mixture buildMixture(const TintPlan& plan, const Tint& tint, const TransferFunction& transfer) {
  Mixture mixture{tint.weights, {}};
  for (std::size_t i = 0; i < plan.components.size(); ++i) {
    const SegmentMedium& medium = plan.components[i];
    Component component{transfer, medium.isClipped};
    if (tint.albedo[i])
      component.transfer.albedo = *tint.albedo[i];
    if (medium.material.kind == MaterialKind::medium)
      applyMaterial(medium.material, component);
    component.transfer = component.transfer.withDensity(medium.density);
    mixture.components.push_back(std::move(component));
  }
  return mixture;
}

} // namespace fenestra::core
