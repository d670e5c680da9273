#include "session/OrganPresets.h"

#include "base/Error.h"
#include "base/safe/ShownText.h"

#include <algorithm>
#include <span>

namespace fenestra {
namespace {

using Fits = std::vector<const OrganPreset*>;

bool hasAny(const std::vector<std::string>& codes, const SegmentInfo& segment) {
  return std::ranges::any_of(codes, [&](const std::string& code) {
    return code == segment.type || code == segment.type + "~" + segment.region;
  });
}

bool modalitiesDiffer(const Fits& fits) {
  return std::ranges::any_of(
      fits, [&](const OrganPreset* preset) { return preset->modality != fits.front()->modality; });
}

std::string listedFits(const Fits& fits, const std::vector<SegmentInfo>& segments) {
  return join(fits, ", ", [&](const OrganPreset* preset) {
    return concat(preset->name, " (", listedNames(focusOf(preset->focus, segments)), ")");
  });
}

} // namespace

std::vector<SegmentInfo> focusOf(const SegmentPatterns& patterns,
                                 const std::vector<SegmentInfo>& segments) {
  std::vector<SegmentInfo> focus;
  std::ranges::copy_if(segments, std::back_inserter(focus), [&](const SegmentInfo& segment) {
    const std::vector<std::string> name = splitName(segment.name);
    return (findPattern(patterns.names, name) || hasAny(patterns.codes, segment)) &&
           !findPattern(patterns.except, name);
  });
  return focus;
}

std::string listedNames(const std::vector<SegmentInfo>& segments) {
  constexpr std::size_t most = 12;
  const auto first = std::span(segments).first(std::min(most, segments.size()));
  const std::string text =
      join(first, ", ", [](const SegmentInfo& segment) { return sanitize(segment.name); });
  return segments.size() > most ? concat(text, " and ", segments.size() - most, " more") : text;
}

const OrganPreset& fittingPreset(const std::vector<OrganPreset>& presets,
                                 const std::vector<SegmentInfo>& segments,
                                 const std::string& source,
                                 const std::function<bool(Modality)>& suits) {
  Fits fits;
  for (const OrganPreset& preset : presets)
    if (!focusOf(preset.focus, segments).empty())
      fits.push_back(&preset);
  const Fits all = fits;
  std::erase_if(fits, [&](const OrganPreset* preset) {
    return std::ranges::any_of(all, [&](const OrganPreset* other) {
      return std::ranges::find(other->before, preset->name) != other->before.end();
    });
  });
  if (fits.size() > 1 && modalitiesDiffer(fits))
    std::erase_if(fits, [&](const OrganPreset* preset) { return !suits(preset->modality); });
  if (fits.empty())
    throw inputError(source, "--preset auto: no preset knows a segment of it (" +
                                 listedNames(segments) +
                                 "); name a preset and give --focus A,B,...");
  if (fits.size() > 1)
    throw inputError(source, "--preset auto: several presets fit, " + listedFits(fits, segments) +
                                 "; name one");
  return *fits.front();
}

} // namespace fenestra
