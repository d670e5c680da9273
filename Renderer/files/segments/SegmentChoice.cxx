// Finds segments by id, name or label value.

#include "base/Error.h"
#include "files/segments/SegmentationReader.h"
#include "io/MessageText.h"

#include <algorithm>
#include <array>
#include <functional>

namespace fenestra::core {
namespace {

constexpr std::size_t maxListed = 12; ///< segments in a message

/// True if each word of the selector, ignoring a final s, begins a word of the name: "Kidneys" and
/// "left kidney" match kidney_left.
bool isLikelyMatch(const std::string& selector, const std::string& name) {
  const std::vector<std::string> words = splitName(name), selectorWords = splitName(selector);
  return !selectorWords.empty() && std::ranges::all_of(selectorWords, [&](std::string word) {
    if (word.size() > 3 && word.back() == 's')
      word.pop_back();
    return std::ranges::any_of(words,
                               [&](const std::string& one) { return one.starts_with(word); });
  });
}

/// Error for an unknown selector, with likely matches, else all segments.
Error makeUnknownError(const std::string& source, const std::string& selector,
                       const std::vector<SegmentInfo>& segments) {
  const auto makeError = [&](ErrorCode code, const std::string& hint) {
    return inputError(code, source, "has no segment \"", sanitize(selector), "\"; ", hint);
  };
  if (segments.empty())
    return makeError(ErrorCode::unknownName, "it has no segments");
  std::vector<SegmentInfo> suggested;
  std::ranges::copy_if(segments, std::back_inserter(suggested),
                       [&](const SegmentInfo& one) { return isLikelyMatch(selector, one.name); });
  if (suggested.empty()) {
    std::vector<std::string> names;
    for (const SegmentInfo& segment : segments)
      names.push_back(toLower(segment.name));
    const std::string nearest = findNearest(toLower(selector), names);
    std::ranges::copy_if(segments, std::back_inserter(suggested), [&](const SegmentInfo& one) {
      return !nearest.empty() && toLower(one.name) == nearest;
    });
  }
  if (!suggested.empty())
    return makeError(
        ErrorCode::unknownName,
        concat("did you mean ",
               join(
                   suggested, ", ", [](const auto& s) { return sanitize(s.name); }, maxListed),
               "?"));
  const bool unnamed = std::ranges::all_of(segments, [](const SegmentInfo& segment) {
    return segment.name == concat("Segment_", segment.labelValue);
  });
  return makeError(unnamed ? ErrorCode::unnamedSegments : ErrorCode::unknownName,
                   "it has " + formatSegments(segments));
}

} // namespace

bool isSelected(const SegmentInfo& segment, std::string_view selector) {
  const std::string bare(trim(selector));
  return segment.id == bare || segment.name == bare ||
         segment.labelValue == parseNumber<std::int32_t>(bare);
}

std::string formatSegments(const std::vector<SegmentInfo>& segments) {
  const auto format = [](const SegmentInfo& segment) {
    const std::string id = sanitize(segment.id);
    return segment.name == segment.id ? id : concat(id, " (", sanitize(segment.name), ')');
  };
  return join(segments, ", ", format, maxListed);
}

std::size_t findSegment(const std::vector<SegmentInfo>& segments, const std::string& selector,
                        const std::string& source) {
  const auto value = parseNumber<std::int32_t>(selector);
  const std::array<std::function<bool(const SegmentInfo&)>, 3> matchers = {
      [&](const SegmentInfo& segment) { return segment.id == selector; },
      [&](const SegmentInfo& segment) { return segment.name == selector; },
      [&](const SegmentInfo& segment) { return segment.labelValue == value; }};
  for (const auto& matches : matchers) {
    std::vector<SegmentInfo> found;
    std::ranges::copy_if(segments, std::back_inserter(found), matches);
    if (found.size() > 1)
      throw inputError(ErrorCode::ambiguousName, source, "segment \"", sanitize(selector),
                       "\" matches several: ", formatSegments(found), "; choose one by its id");
    if (!found.empty())
      return static_cast<std::size_t>(std::ranges::find_if(segments, matches) - segments.begin());
  }
  if (const std::string_view bare = trim(selector); bare.size() < selector.size())
    return findSegment(segments, std::string(bare), source);
  throw makeUnknownError(source, selector, segments);
}

} // namespace fenestra::core
