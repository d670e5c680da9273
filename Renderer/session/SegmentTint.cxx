#include "session/SegmentTint.h"

#include "base/Error.h"
#include "base/safe/ShownText.h"
#include "model/medium/Reflectance.h"
#include "session/SegmentMaterials.h"

#include <algorithm>
#include <map>

namespace fenestra {
namespace {

constexpr std::size_t mostComponents = 256; ///< a component is a byte

/// Refuses `matter`, a segment's, where tint cannot show it. `who`: who asks for it.
void requireTint(const SegmentMatter& matter, const std::string& who) {
  constexpr const char* why = ", and materials only colour yet; ";
  if (matter.material.kind != MaterialKind::tint)
    throw inputError(who, "kind: is \"matter\"", why, "make it \"tint\", without \"extinction\"");
  if (matter.density != 1.0)
    throw inputError(who, "density: is ", numberText(matter.density), why, "leave it at 1");
  if (!matter.isClipped)
    throw inputError(who, "clip: is false", why, "leave it at true");
}

/// Material of each segment, with the changes; empty segments as they come.
std::vector<SegmentMaterial> matterOf(const Segmentation& segmentation,
                                      const std::vector<SegmentStatistics>& statistics,
                                      const NamedMaterials& materials,
                                      const std::vector<std::string>& changes) {
  const std::vector<SegmentInfo>& segments = segmentation.segments();
  std::vector<SegmentMaterial> all = materialsOf(segments, materials.table);
  std::vector<std::string> sources(all.size(), materials.source);
  if (materials.table.hasContrast)
    for (SegmentMaterial& material : all)
      if (material.isOfPalette)
        material.matter.material = {};
  for (const std::string& text : changes) {
    const MaterialChange change = parseMaterialChange(text, materials.table);
    const std::size_t i = segmentation.find(change.selector);
    all[i].matter = changed(all[i].matter, change, materials.table);
    sources[i] = "--material";
  }
  for (std::size_t i = 0; i < all.size(); ++i)
    if (statistics[i].voxels > 0)
      requireTint(all[i].matter, textOf(sources[i], ": segment \"", shown(segments[i].name), "\""));
  return all;
}

/// Material of what no segment covers.
Material restOf(const NamedMaterials& materials) {
  const MaterialTable& table = materials.table;
  if (table.rest.empty())
    return {};
  const Material& rest = table.materials.at(table.rest);
  requireTint({rest}, textOf(materials.source, ": rest \"", shown(table.rest), "\""));
  return rest;
}

/// True if both give one albedo under any transfer function.
bool looksLike(const Material& a, const Material& b) {
  if (!a.color || !b.color)
    return a.color.has_value() == b.color.has_value();
  return a.colorIsAlbedo == b.colorIsAlbedo &&
         std::ranges::equal(a.color->knots(), b.color->knots(), [](const auto& k, const auto& l) {
           return k.position == l.position && k.value == l.value;
         });
}

/// Component of the material's look, a new one if there is none. `segment`: its name.
std::uint8_t componentOf(const SegmentMaterial& material, const std::string& segment, bool isFocus,
                         TintPlan& plan, const std::string& source) {
  const std::string& name = material.name.empty() ? segment : material.name;
  for (std::size_t i = 0; i < plan.components.size(); ++i)
    if (plan.isFocus[i] == isFocus && looksLike(material.matter.material, plan.components[i])) {
      if (i > 0)
        plan.names[i] = name;
      return static_cast<std::uint8_t>(i);
    }
  if (plan.components.size() == mostComponents)
    throw inputError(source, "its segments have more than ", mostComponents - 1,
                     " colours; give several of them one material with --materials FILE");
  plan.components.push_back(material.matter.material);
  plan.names.push_back(segment);
  plan.isFocus.push_back(isFocus);
  return static_cast<std::uint8_t>(plan.components.size() - 1);
}

/// Segments of the focus, by place; none where materials do not set it off.
std::vector<bool> focusOf(const Segmentation& segmentation, const NamedMaterials& materials,
                          const std::vector<std::string>& focus) {
  const ContextColors& context = materials.table.context;
  if (focus.empty() && (context.saturation || context.lightness))
    throw inputError(materials.source,
                     "context: is what is not focus; add --focus, or leave it out");
  std::vector<bool> isFocus(segmentation.segments().size());
  if (materials.setsOffFocus())
    for (const std::string& selector : focus)
      isFocus[segmentation.find(selector)] = true;
  return isFocus;
}

/// Parts without those of component 0 that leave to others what they cover.
std::vector<TintPart> withoutIdle(std::vector<TintPart> parts) {
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

} // namespace

TintPlan tintPlan(const Handle<SegmentsInput>& input, const Handle<NamedMaterials>& materials,
                  const std::vector<std::string>& changes, const std::vector<std::string>& focus) {
  const Segmentation& segmentation = input->segmentation;
  const std::vector<SegmentStatistics> statistics = segmentation.statistics();
  const std::vector<SegmentMaterial> all = matterOf(segmentation, statistics, *materials, changes);
  const std::vector<bool> isFocus = focusOf(segmentation, *materials, focus);
  TintPlan plan{
      .parts = {}, .components = {restOf(*materials)}, .names = {"the rest"}, .isFocus = {false}};
  std::map<std::pair<std::uint8_t, int>, std::vector<std::size_t>> segments;
  for (std::size_t i = 0; i < all.size(); ++i)
    if (statistics[i].voxels > 0) {
      const std::uint8_t component = componentOf(all[i], segmentation.segments()[i].name,
                                                 isFocus[i], plan, segmentation.source());
      segments[{component, all[i].matter.priority}].push_back(i);
    }
  for (auto& [of, places] : segments)
    plan.parts.push_back({std::move(places), of.second, of.first});
  plan.parts = withoutIdle(std::move(plan.parts));
  if (plan.parts.empty())
    throw inputError(segmentation.source(),
                     "no segment has a voxel, so there is nothing to colour; drop --materials");
  return plan;
}

Shares tintShares(const Handle<SegmentsInput>& input, const std::vector<TintPart>& parts,
                  const std::optional<double>& smoothing, const Grid& volume) {
  const Segmentation& segmentation = input->segmentation;
  const auto partAt = [&](std::size_t number) -> Shares::Part {
    const TintPart& part = parts[number];
    std::vector<SegmentInfo> segments;
    for (const std::size_t i : part.segments)
      segments.push_back(segmentation.segments()[i]);
    return {segmentation.maskOf(segments, volume, {.margins = {}, .smoothing = smoothing}),
            part.priority, part.component};
  };
  return {parts.size(), partAt};
}

Tint tintOf(const Handle<TintPlan>& plan, const Handle<Shares>& shares, double g) {
  Tint tint{shares, {}};
  for (const Material& material : plan->components) {
    const std::optional<ColorFunction>& color = material.color;
    const bool isAlbedo = material.colorIsAlbedo;
    tint.albedo.push_back(!color || isAlbedo ? color : std::optional(albedoFor(*color, g)));
  }
  return tint;
}

} // namespace fenestra
