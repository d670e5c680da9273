#include "files/appearance/SegmentPatterns.h"

#include "base/Text.h"

#include <algorithm>
#include <regex>

namespace fenestra::core {
namespace {

/// Reads a pattern or a code as text.
std::string readPatternString(const JsonNode& node) {
  constexpr std::size_t maxLength = 200;
  std::string text = node.text();
  if (text.empty() || text.size() > maxLength)
    throw node.error(concat("must have 1 to ", maxLength, " characters"));
  return text;
}

/// Backtracks only to the last *, so time is at most the product of both lengths.
bool matchesGlob(std::string_view glob, std::string_view word) {
  std::size_t g = 0, w = 0;                               // positions in glob and word
  std::size_t star = std::string_view::npos, starEnd = 0; // last *, and where its text in word ends
  while (w < word.size()) {
    if (g < glob.size() && glob[g] == '*') {
      star = g++;
      starEnd = w;
    } else if (g < glob.size() && (glob[g] == '?' || glob[g] == word[w])) {
      ++g;
      ++w;
    } else if (star != std::string_view::npos) {
      g = star + 1;
      w = ++starEnd;
    } else {
      return false;
    }
  }
  return glob.find_first_not_of('*', g) == std::string_view::npos;
}

} // namespace

std::vector<std::string> readPatternStrings(const JsonNode& parent, const std::string& key) {
  std::vector<std::string> texts;
  const auto node = parent.find(key);
  for (const JsonNode& element : node ? node->elements() : std::vector<JsonNode>())
    texts.push_back(readPatternString(element));
  return texts;
}

std::string readCode(const JsonNode& node) {
  // SCHEME^VALUE of a type, and of a region if ~ follows
  static const std::regex pattern(R"([^^~]+\^[^^~]+(~[^^]+\^[^^~]+)?)");
  std::string code = readPatternString(node);
  if (!std::regex_match(code, pattern))
    throw node.error(
        "must be a code like \"SCT^39607008\", or with a region \"SCT^4147007~SCT^12738006\"");
  return code;
}

SegmentPatterns readPatterns(const JsonNode& node) {
  const auto readNames = [&](const char* key) {
    const std::vector<std::string> texts = readPatternStrings(node, key);
    return std::vector<NamePattern>(texts.begin(), texts.end());
  };
  SegmentPatterns patterns{readNames("names"), readNames("except")};
  if (const auto codes = node.find("codes"))
    for (const JsonNode& code : codes->elements())
      patterns.codes.push_back(readCode(code));
  return patterns;
}

NamePattern::NamePattern(std::string text)
    : text(std::move(text)), words(splitName(this->text, "*?")) {}

bool NamePattern::matches(const std::vector<std::string>& name) const {
  return !words.empty() && std::search(name.begin(), name.end(), words.begin(), words.end(),
                                       [](const std::string& word, const std::string& glob) {
                                         return matchesGlob(glob, word);
                                       }) != name.end();
}

const NamePattern* findPattern(const std::vector<NamePattern>& patterns,
                               const std::vector<std::string>& name) {
  const auto found = std::ranges::find_if(
      patterns, [&](const NamePattern& pattern) { return pattern.matches(name); });
  return found == patterns.end() ? nullptr : &*found;
}

} // namespace fenestra::core
