#include "scene/OrganPresets.h"

#include "base/Error.h"
#include "io/MessageText.h"

#include <algorithm>
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

} // namespace fenestra::core
