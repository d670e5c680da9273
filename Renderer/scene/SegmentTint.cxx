#include "scene/SegmentTint.h"

#include "base/Error.h"
#include "model/masks/OuterLayer.h"
#include "model/medium/Reflectance.h"
#include "scene/SegmentMaterials.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <tuple>

namespace fenestra {
namespace {

constexpr std::size_t mostComponents = 256; ///< a component is a byte
constexpr const char* skinMaterial = "skin";
constexpr int skinPriority = 1;

/// Material of each segment, with the changes; empty segments as they come.
std::vector<SegmentMaterial> collectMaterials(const Segmentation& segmentation,
                                              const NamedMaterials& materials,
                                              const std::vector<std::string>& changes) {
  const std::vector<SegmentInfo>& segments = segmentation.segments();
  std::vector<SegmentMaterial> all = assignMaterials(segments, materials.table);
  if (materials.table.hasContrast)
    for (SegmentMaterial& material : all)
      if (material.isFromPalette)
        material.medium.material = {};
  for (const std::string& text : changes) {
    const MaterialChange change = parseMaterialChange(text, materials.table);
    const std::size_t i = segmentation.find(change.selector);
    all[i].medium = applyChange(all[i].medium, change, materials.table);
  }
  return all;
}

/// Places of the segments by name, then id: components are numbered so, and pictures do not depend
/// on the order in a file.
std::vector<std::size_t> sortByName(const std::vector<SegmentInfo>& segments) {
  std::vector<std::size_t> indices(segments.size());
  std::iota(indices.begin(), indices.end(), std::size_t{0});
  std::ranges::stable_sort(
      indices, {}, [&](std::size_t i) { return std::tie(segments[i].name, segments[i].id); });
  return indices;
}

/// Material of what no segment covers.
Material unlabeledMaterial(const NamedMaterials& materials) {
  const MaterialTable& table = materials.table;
  return table.rest.empty() ? Material() : table.materials.at(table.rest);
}

/// True if a segment that has voxels is skin.
bool hasSkin(const std::vector<SegmentMaterial>& all, const std::vector<bool>& hasVoxels) {
  for (std::size_t i = 0; i < all.size(); ++i)
    if (hasVoxels[i] && all[i].name == skinMaterial)
      return true;
  return false;
}

/// True if both are the same under any transfer function; priority aside.
bool isSame(const SegmentMedium& a, const SegmentMedium& b) {
  const Material &m = a.material, &n = b.material;
  const bool looksAlike = m.color == n.color && (!m.color || m.colorIsAlbedo == n.colorIsAlbedo);
  if (!looksAlike || m.kind != n.kind || a.isClipped != b.isClipped || a.density != b.density)
    return false;
  return m.kind == MaterialKind::tint ||
         (m.extinction == n.extinction &&
          std::tie(m.g, m.diffuse, m.specular, m.roughness, m.interfaceWeight) ==
              std::tie(n.g, n.diffuse, n.specular, n.roughness, n.interfaceWeight));
}

/// Component of the matter, a new one if there is none. `segment`: its name.
std::uint8_t findComponent(const SegmentMaterial& material, const std::string& segment,
                           bool isFocus, TintPlan& plan, const std::string& source) {
  const std::string& name = material.name.empty() ? segment : material.name;
  for (std::size_t i = 0; i < plan.components.size(); ++i)
    if (plan.isFocus[i] == isFocus && isSame(material.medium, plan.components[i])) {
      if (i > 0)
        plan.names[i] = name;
      return static_cast<std::uint8_t>(i);
    }
  if (plan.components.size() == mostComponents)
    throw inputError(source, "its segments have more than ", mostComponents - 1,
                     " materials; give several of them one material with --materials FILE");
  plan.components.push_back(material.medium);
  plan.names.push_back(segment);
  plan.isFocus.push_back(isFocus);
  return static_cast<std::uint8_t>(plan.components.size() - 1);
}

/// Segments of the focus, by place; none where materials do not set it off.
std::vector<bool> markFocus(const Segmentation& segmentation, const NamedMaterials& materials,
                            const std::vector<std::string>& focus) {
  const ContextColors& context = materials.table.context;
  if (focus.empty() && (context.saturation || context.lightness))
    throw inputError(materials.source,
                     "context: is what is not focus; add --focus, or leave it out");
  std::vector<bool> isFocus(segmentation.segments().size());
  if (materials.hasColorAdjustment())
    for (const std::string& selector : focus)
      isFocus[segmentation.find(selector)] = true;
  return isFocus;
}

/// Gives a smoothed part all of what it has half of: the surface of a focus, which lies there, is
/// not shown in a mixture of its colour with the context's.
void saturate(Mask& mask) {
  for (std::uint8_t& voxel : mask.voxels)
    voxel = static_cast<std::uint8_t>(std::min(2 * voxel, int{mask.maxValue}));
}

/// Parts without those of component 0 that leave to others what they cover.
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

/// Takes what a material says beside colour; the component is of the volume's own matter, with the
/// material's albedo for that one's mean cosine.
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
                      const std::vector<std::string>& focus, const Handle<Mask>& skin) {
  const Segmentation& segmentation = input->segmentation;
  const std::vector<SegmentMaterial> all = collectMaterials(segmentation, *materials, changes);
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
  const bool canGrow = isTintOnly(plan); // matter stays where its segment is
  for (auto& [of, places] : segments)
    plan.parts.push_back(
        {std::move(places), of.second, of.first, canGrow && plan.isFocus[of.first]});
  if (skin && skin->count > 0 && !hasSkin(all, *hasVoxels)) {
    const Material& material = materials->table.materials.at(skinMaterial);
    const std::uint8_t component =
        findComponent({{material}, skinMaterial}, skinMaterial, false, plan, segmentation.source());
    plan.parts.push_back({{}, skinPriority, component});
  }
  plan.parts = removeRedundant(std::move(plan.parts));
  if (plan.parts.empty())
    throw inputError(segmentation.source(),
                     "no segment has a voxel, so there is nothing to colour; drop --materials");
  return plan;
}

LabelWeights computeLabelWeights(const Handle<SegmentsInput>& input,
                                 const std::vector<TintPart>& parts, const Handle<Mask>& skin,
                                 const std::optional<double>& smoothing, const Grid& volume) {
  const Segmentation& segmentation = input->segmentation;
  std::optional<Grid> labels; // of the parts before
  const auto partAt = [&](std::size_t number) -> LabelWeights::Part {
    const TintPart& part = parts[number];
    if (part.segments.empty())
      return {resampleMask(*skin, labels.value_or(skin->grid), volume), part.priority,
              part.component};
    std::vector<SegmentInfo> segments;
    for (const std::size_t i : part.segments)
      segments.push_back(segmentation.segments()[i]);
    Mask mask = segmentation.makeMask(segments, volume, {.margins = {}, .smoothing = smoothing});
    if (part.isFocus)
      saturate(mask);
    labels = mask.grid;
    return {std::move(mask), part.priority, part.component};
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

} // namespace fenestra
