#include "files/appearance/PresetReader.h"

#include "io/JsonNode.h"

#include <filesystem>

namespace fenestra::core {
namespace {

constexpr Modality modalities[] = {Modality::ct, Modality::mr, Modality::us};

SegmentPatterns readFocus(const JsonNode& node) {
  node.allowOnly({"names", "except", "codes"});
  SegmentPatterns focus = readPatterns(node);
  if (focus.names.empty() && focus.codes.empty())
    throw node.error("has neither \"names\" nor \"codes\"; add patterns of segment names");
  return focus;
}

/// Value of an option as on the command line: text, a number, numbers, or JSON (a transfer function
/// or lights).
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

} // namespace

OrganPreset parsePreset(std::string_view json, const std::string& source) {
  const nlohmann::json document = parseJson(json, source);
  const JsonNode root(document, source);
  root.allowOnly({"title", "modality", "focus", "before", "flags", "tested"});
  OrganPreset preset{.name = std::filesystem::path(source).stem().string(),
                     .title = root.at("title").text(),
                     .modality = modalities[root.at("modality").choice({"CT", "MR", "US"})],
                     .focus = readFocus(root.at("focus")),
                     .before = readPatternStrings(root, "before")};
  for (const auto& [option, value] : root.at("flags").members())
    preset.options.emplace_back(option, readValue(value));
  if (const auto tested = root.find("tested"))
    preset.tested = tested->text();
  return preset;
}

} // namespace fenestra::core
