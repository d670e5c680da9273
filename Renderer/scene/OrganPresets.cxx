#include "scene/OrganPresets.h"

#include "base/Error.h"
#include "io/MessageText.h"
#include "scene/Defaults.h"
#include "scene/NamedPresets.h"

#include <algorithm>
#include <set>
#include <span>

namespace fenestra::core {
namespace {

using Matches = std::vector<const OrganPreset*>;

bool hasCode(const std::vector<std::string>& codes, const SegmentInfo& segment) {
  return std::ranges::any_of(codes, [&](const std::string& code) {
    return code == segment.type || code == segment.type + "~" + segment.region;
  });
}

bool hasMixedModalities(const Matches& matches) {
  return std::ranges::any_of(matches, [&](const OrganPreset* preset) {
    return preset->modality != matches.front()->modality;
  });
}

Matches listMatchingPresets(const std::vector<OrganPreset>& presets,
                            const std::vector<SegmentInfo>& segments) {
  Matches matches;
  for (const OrganPreset& preset : presets)
    if (!findFocusSegments(preset.focus, segments).empty())
      matches.push_back(&preset);
  return matches;
}

std::string listMatches(const Matches& matches, const std::vector<SegmentInfo>& segments) {
  return join(matches, ", ", [&](const OrganPreset* preset) {
    return concat(preset->name, " (", joinSegmentNames(findFocusSegments(preset->focus, segments)),
                  ")");
  });
}

/// Segments that the focus names; all if it is empty.
std::vector<SegmentInfo> selectFocus(const std::vector<std::string>& focus,
                                     const std::vector<SegmentInfo>& segments) {
  std::vector<SegmentInfo> selected;
  std::ranges::copy_if(segments, std::back_inserter(selected), [&](const SegmentInfo& segment) {
    return std::ranges::any_of(
        focus, [&](const std::string& selector) { return isSelected(segment, selector); });
  });
  return selected.empty() ? segments : selected;
}

/// Selectors of some of `all` segments, each once: ids, or names where several have the id.
std::vector<std::string> makeSelectors(const std::vector<SegmentInfo>& chosen,
                                       const std::vector<SegmentInfo>& all) {
  std::vector<std::string> selectors;
  for (const SegmentInfo& segment : chosen) {
    const bool isUnique = std::ranges::count(all, segment.id, &SegmentInfo::id) == 1;
    const std::string& selector = isUnique ? segment.id : segment.name;
    if (std::ranges::find(selectors, selector) == selectors.end())
      selectors.push_back(selector);
  }
  return selectors;
}

/// Segments, by id and name, that have a voxel in the segmentation.
std::vector<SegmentInfo> selectNonEmpty(std::vector<SegmentInfo> segments,
                                        const Segmentation& segmentation) {
  std::set<std::pair<std::string, std::string>> present;
  const std::vector<SegmentStatistics> statistics = segmentation.statistics();
  for (std::size_t i = 0; i < statistics.size(); ++i)
    if (const SegmentInfo& one = segmentation.segments()[i]; statistics[i].voxels > 0)
      present.emplace(one.id, one.name);
  std::erase_if(segments, [&](const SegmentInfo& one) {
    return !present.contains({one.id, one.name});
  });
  return segments;
}

OrganPreset findSuitablePreset(const Input& input, const InputChoice& choice,
                               const VolumeChoice& volume, const SegmentNames& names) {
  std::vector<OrganPreset> presets;
  for (const std::string& name : listBuiltinPresets("presets"))
    presets.push_back(findOrganPreset(name));
  const std::vector<SegmentInfo> candidates = selectFocus(choice.focus, names.segments);
  const auto listNonEmpty = [&] {
    InputChoice candidateChoice = choice;
    candidateChoice.focus = makeSelectors(candidates, names.segments);
    return selectNonEmpty(candidates, input.segments(candidateChoice)->segmentation);
  };
  return findMatchingPreset(presets, candidates, names.source, listNonEmpty,
                            [&](Modality modality) {
                              return isPlausibleModality(modality, input.volume(volume)->volume);
                            });
}

} // namespace

std::vector<SegmentInfo> findFocusSegments(const SegmentPatterns& patterns,
                                           const std::vector<SegmentInfo>& segments) {
  std::vector<SegmentInfo> focus;
  std::ranges::copy_if(segments, std::back_inserter(focus), [&](const SegmentInfo& segment) {
    const std::vector<std::string> name = splitName(segment.name);
    return (findPattern(patterns.names, name) || hasCode(patterns.codes, segment)) &&
           !findPattern(patterns.except, name);
  });
  return focus;
}

std::string joinSegmentNames(const std::vector<SegmentInfo>& segments) {
  constexpr std::size_t limit = 12;
  const auto first = std::span(segments).first(std::min(limit, segments.size()));
  const std::string text =
      join(first, ", ", [](const SegmentInfo& segment) { return sanitize(segment.name); });
  return segments.size() > limit ? concat(text, " and ", segments.size() - limit, " more") : text;
}

const OrganPreset& findMatchingPreset(const std::vector<OrganPreset>& presets,
                                      const std::vector<SegmentInfo>& named,
                                      const std::string& source,
                                      const std::function<std::vector<SegmentInfo>()>& listNonEmpty,
                                      const std::function<bool(Modality)>& isSuitable) {
  std::vector<SegmentInfo> segments = named;
  Matches matches = listMatchingPresets(presets, segments);
  if (matches.size() > 1) {
    segments = listNonEmpty();
    matches = listMatchingPresets(presets, segments);
  }
  const Matches all = matches;
  std::erase_if(matches, [&](const OrganPreset* preset) {
    return std::ranges::any_of(all, [&](const OrganPreset* other) {
      return std::ranges::find(other->before, preset->name) != other->before.end();
    });
  });
  if (matches.size() > 1 && hasMixedModalities(matches))
    std::erase_if(matches,
                  [&](const OrganPreset* preset) { return !isSuitable(preset->modality); });
  if (matches.empty())
    throw inputError(ErrorCode::noMatchingPreset, source,
                     "no preset matches a segment (" + joinSegmentNames(segments) + ")");
  if (matches.size() > 1)
    throw inputError(ErrorCode::ambiguousPreset, source,
                     "several presets match, " + listMatches(matches, segments));
  return *matches.front();
}

ChosenPreset chooseOrganPreset(const std::string& name, const Input& input,
                               const InputChoice& choice, const VolumeChoice& volume) {
  const bool isAutomatic = name == "auto";
  std::optional<SegmentNames> names;
  if (isAutomatic || choice.focus.empty()) {
    InputChoice all = choice; // of several segmentations, whichever has the preset's segments
    all.focus.clear();
    names = input.segmentNames(all);
  }
  if (isAutomatic && !names)
    throw requestError(ErrorCode::segmentationRequired, "preset auto",
                       "is chosen by segment names");
  if (names && names->segments.empty())
    throw inputError(ErrorCode::unnamedSegments, names->source, "preset ", name,
                     " finds no segment: they have no names, only values");
  ChosenPreset chosen = {isAutomatic ? findSuitablePreset(input, choice, volume, *names)
                                     : findOrganPreset(name),
                         choice.focus};
  if (!names || !choice.focus.empty())
    return chosen;
  chosen.focus =
      makeSelectors(findFocusSegments(chosen.preset.focus, names->segments), names->segments);
  if (chosen.focus.empty())
    throw inputError(ErrorCode::noMatchingPreset, names->source, "has no segment of preset ",
                     chosen.preset.name, " (only ", joinSegmentNames(names->segments), ")");
  return chosen;
}

} // namespace fenestra::core
