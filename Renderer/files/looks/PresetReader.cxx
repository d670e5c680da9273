#include "files/looks/PresetReader.h"

#include "base/Text.h"
#include "base/safe/JsonNode.h"

#include <algorithm>
#include <regex>

namespace fenestra {
namespace {

constexpr Modality modalities[] = {Modality::ct, Modality::mr, Modality::us};
constexpr std::size_t longestPattern = 200;

std::vector<std::string> textsAt(const JsonNode& parent, const std::string& key) {
  std::vector<std::string> texts;
  const auto node = parent.find(key);
  for (const JsonNode& element : node ? node->elements() : std::vector<JsonNode>()) {
    texts.push_back(element.text());
    if (texts.back().empty() || texts.back().size() > longestPattern)
      throw element.error(textOf("must have 1 to ", longestPattern, " characters"));
  }
  return texts;
}

/// "SCHEME^VALUE", or two of them with ~ between.
bool isCode(const std::string& text) {
  static const std::regex pattern(R"([^^~]+\^[^^~]+(~[^^]+\^[^^~]+)?)");
  return std::regex_match(text, pattern);
}

FocusPatterns readFocus(const JsonNode& node) {
  node.allowOnly({"names", "except", "codes"});
  FocusPatterns focus{textsAt(node, "names"), textsAt(node, "except"), textsAt(node, "codes")};
  if (focus.names.empty() && focus.codes.empty())
    throw node.error("has neither \"names\" nor \"codes\"; add patterns of segment names");
  for (std::size_t i = 0; i < focus.codes.size(); ++i)
    if (!isCode(focus.codes[i]))
      throw node.at("codes").elements()[i].error(
          "must be a code like \"SCT^39607008\", or with its region \"SCT^4147007~SCT^12738006\"");
  return focus;
}

/// Value of a flag as on the command line: a text, a number, numbers, or a look's JSON.
std::string readValue(const JsonNode& node) {
  if (node.isObject() || node.isNumber())
    return node.json();
  if (!node.isArray())
    return node.text();
  std::string text;
  for (const JsonNode& element : node.elements()) {
    element.number();
    text.append(text.empty() ? "" : ",").append(element.json());
  }
  return text;
}

/// Backtracks to the last * only: time at most the product of both lengths.
bool matchesGlob(std::string_view glob, std::string_view word) {
  std::size_t g = 0, w = 0, star = std::string_view::npos, from = 0;
  while (w < word.size()) {
    if (g < glob.size() && glob[g] == '*') {
      star = g++;
      from = w;
    } else if (g < glob.size() && (glob[g] == '?' || glob[g] == word[w])) {
      ++g;
      ++w;
    } else if (star != std::string_view::npos) {
      g = star + 1;
      w = ++from;
    } else {
      return false;
    }
  }
  return glob.find_first_not_of('*', g) == std::string_view::npos;
}

} // namespace

OrganPreset parsePreset(std::string_view json, const std::string& source) {
  const nlohmann::json document = parseJson(json, source);
  const JsonNode root(document, source);
  root.allowOnly({"title", "modality", "focus", "before", "flags", "tested"});
  OrganPreset preset{.name = std::filesystem::path(source).stem().string(),
                     .title = root.at("title").text(),
                     .modality = modalities[root.at("modality").oneOf({"CT", "MR", "US"})],
                     .focus = readFocus(root.at("focus")),
                     .before = textsAt(root, "before")};
  for (const auto& [flag, value] : root.at("flags").members())
    preset.flags.emplace_back(flag, readValue(value));
  if (const auto tested = root.find("tested"))
    preset.tested = tested->text();
  return preset;
}

bool matchesName(std::string_view pattern, std::string_view name) {
  const std::vector<std::string> globs = nameWords(pattern, "*?");
  const std::vector<std::string> words = nameWords(name);
  return !globs.empty() && std::search(words.begin(), words.end(), globs.begin(), globs.end(),
                                       [](const std::string& word, const std::string& glob) {
                                         return matchesGlob(glob, word);
                                       }) != words.end();
}

} // namespace fenestra
