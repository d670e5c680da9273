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

/// Matter of each segment, with the changes; empty segments as they come.
std::vector<SegmentMatter> matterOf(const Segmentation& segmentation,
                                    const std::vector<SegmentStatistics>& statistics,
                                    const NamedMaterials& materials,
                                    const std::vector<std::string>& changes) {
  const std::vector<SegmentInfo>& segments = segmentation.segments();
  std::vector<SegmentMatter> all;
  std::vector<std::string> sources;
  for (const SegmentMaterial& material : materialsOf(segments, materials.table)) {
    all.push_back(material.matter);
    sources.push_back(materials.source);
  }
  for (const std::string& text : changes) {
    const MaterialChange change = parseMaterialChange(text, materials.table);
    const std::size_t i = segmentation.find(change.selector);
    all[i] = changed(all[i], change, materials.table);
    sources[i] = "--material";
  }
  for (std::size_t i = 0; i < all.size(); ++i)
    if (statistics[i].voxels > 0)
      requireTint(all[i], textOf(sources[i], ": segment \"", shown(segments[i].name), "\""));
  return all;
}

/// Material of what no segment covers.
Material restOf(const NamedMaterials& materials) {
  const MaterialTable& table = materials.table;
  if (table.context.saturation != 1.0 || table.context.lightness != 0.0)
    throw inputError(materials.source,
                     "context: is not applied yet; leave it out, and give --contextsaturation");
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

/// Component of that look, a new one if there is none.
std::uint8_t componentOf(const Material& material, std::vector<Material>& components,
                         const std::string& source) {
  const auto like = [&](const Material& other) { return looksLike(material, other); };
  const auto found = std::ranges::find_if(components, like);
  const auto component = static_cast<std::size_t>(found - components.begin());
  if (found == components.end())
    components.push_back(material);
  if (components.size() > mostComponents)
    throw inputError(source, "its segments have more than ", mostComponents - 1,
                     " colours; give several of them one material with --materials FILE");
  return static_cast<std::uint8_t>(component);
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
                  const std::vector<std::string>& changes) {
  const Segmentation& segmentation = input->segmentation;
  const std::vector<SegmentStatistics> statistics = segmentation.statistics();
  const std::vector<SegmentMatter> matter = matterOf(segmentation, statistics, *materials, changes);
  TintPlan plan{.parts = {}, .components = {restOf(*materials)}};
  std::map<std::pair<std::uint8_t, int>, std::vector<std::size_t>> segments;
  for (std::size_t i = 0; i < matter.size(); ++i)
    if (statistics[i].voxels > 0) {
      const std::uint8_t component =
          componentOf(matter[i].material, plan.components, segmentation.source());
      segments[{component, matter[i].priority}].push_back(i);
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
