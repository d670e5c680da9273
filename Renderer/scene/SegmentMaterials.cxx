#include "scene/SegmentMaterials.h"

#include "base/Color.h"
#include "base/Text.h"
#include "io/EmbeddedResources.h"

#include <algorithm>
#include <array>
#include <span>
#include <tuple>

namespace fenestra::core {
namespace {

/// Attribute of a segment that a rule matches, weakest first.
enum class Match { none, name, region, category, type, typeAndRegion, value };

struct RuleMatch {
  Match match = Match::none;
  std::string reason;
};

bool hasElement(const auto& list, const auto& value) {
  return std::ranges::find(list, value) != list.end();
}

/// Match by the segment's codes, which are empty if it has none.
RuleMatch findCode(const MaterialRule& rule, const SegmentInfo& segment) {
  const std::vector<std::string>& codes = rule.patterns.codes;
  const std::string both = segment.type + "~" + segment.region;
  if (hasElement(codes, both))
    return {Match::typeAndRegion, "by " + both};
  if (hasElement(codes, segment.type))
    return {Match::type, "by " + segment.type};
  if (!rule.category.empty() && rule.category == segment.category)
    return {Match::category, "by category " + segment.category};
  if (hasElement(codes, segment.region))
    return {Match::region, "by region " + segment.region};
  return {};
}

/// Strongest match of the rule; `words`: of the segment name.
RuleMatch findMatch(const MaterialRule& rule, const SegmentInfo& segment,
                    const std::vector<std::string>& words) {
  RuleMatch found = findCode(rule, segment);
  if (hasElement(rule.values, segment.labelValue))
    found = {Match::value, concat("by value ", segment.labelValue)};
  if (found.match == Match::none)
    if (const NamePattern* pattern = findPattern(rule.patterns.names, words))
      found = {Match::name, "by name '" + pattern->text + "'"};
  if (found.match != Match::none && findPattern(rule.patterns.except, words))
    return {};
  return found;
}

std::optional<SegmentMaterial> matchRules(const SegmentInfo& segment, const MaterialTable& table) {
  const std::vector<std::string> words = splitName(segment.name);
  const MaterialRule* best = nullptr;
  RuleMatch bestFound;
  const auto rank = [](const MaterialRule& rule, const RuleMatch& found) {
    return std::tuple(rule.isFromFile, found.match, found.match == Match::name ? rule.priority : 0);
  };
  for (const MaterialRule& rule : table.rules) {
    RuleMatch found = findMatch(rule, segment, words);
    if (found.match != Match::none && (!best || rank(rule, found) > rank(*best, bestFound))) {
      best = &rule;
      bestFound = std::move(found);
    }
  }
  if (!best)
    return std::nullopt;
  return SegmentMaterial{
      {table.materials.at(best->material), best->priority, best->isClipped, best->density},
      best->material,
      std::move(bestFound.reason)};
}

/// Gray that Slicer and Fenestra assign to segments without a color.
bool isDefaultGray(const Rgb& color) {
  constexpr double byte = 1.0 / 255.0;
  return ((color - 0.5).abs() < byte).all();
}

SegmentMaterial makeColored(const Rgb& encoded, const char* reason) {
  SegmentMaterial result{.reason = reason};
  result.medium.material.color = ColorFunction({{0.0, decodeSrgb(encoded)}});
  return result;
}

/// sRGB colors. Each has the largest possible CIELAB distance from those before it, at lightness 45
/// to 88 and chroma 24 to 68; the smallest distance between two is 30.
constexpr std::array<std::uint32_t, 20> palette = {
    0x9396ec, 0xc5e057, 0xc4362b, 0x11ece6, 0x706c43, 0xe74da3, 0xf2a236,
    0xffb7ba, 0x0c9d52, 0x1b7f97, 0xbfddac, 0x8f5a79, 0xa9daff, 0x9648b7,
    0x71871b, 0x9b5b15, 0xfdb0f3, 0xd5ad73, 0x47977c, 0x30f0ad};

} // namespace

const MaterialTable& materialLibrary() {
  static const MaterialTable library = [] {
    MaterialTable all;
    for (const std::string& file : listResources("materials/")) {
      MaterialTable table = parseMaterials(findResource(file), file);
      all.materials.merge(table.materials);
      std::ranges::move(table.rules, std::back_inserter(all.rules));
    }
    return all;
  }();
  return library;
}

std::vector<SegmentMaterial> assignMaterials(const std::vector<SegmentInfo>& segments,
                                             const MaterialTable& table) {
  std::vector<SegmentMaterial> materials;
  std::size_t unknown = 0;
  for (const SegmentInfo& segment : segments) {
    if (auto found = matchRules(segment, table))
      materials.push_back(std::move(*found));
    else if (!isDefaultGray(segment.color))
      materials.push_back(makeColored(segment.color, "by its own color"));
    else {
      materials.push_back(makeColored(hexToRgb(palette[unknown++ % palette.size()]), "by palette"));
      materials.back().isFromPalette = true;
    }
  }
  return materials;
}

bool hasKnownMaterial(const Segmentation& segmentation, const std::vector<std::string>& selectors) {
  const std::vector<SegmentMaterial> all =
      assignMaterials(segmentation.segments(), materialLibrary());
  return std::ranges::any_of(selectors, [&](const std::string& selector) {
    return !all[segmentation.find(selector)].isFromPalette;
  });
}

} // namespace fenestra::core
