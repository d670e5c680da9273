#include "cli/SceneFlags.h"

#include "cli/PresetFlags.h"
#include "io/mrml/MrmlScene.h"

#include <algorithm>

namespace fenestra {
namespace {

/// Flags that decide one thing together; any other flag decides by itself.
const std::vector<std::vector<std::string>> kinds = {
    {"view", "position", "target", "up", "projection", "scale", "angle"},
    {"clip", "boundary", "controlpoints", "smoothing", "plane", "hole", "holemargin", "ghost",
     "offset", "soft"},
    {"samples", "seconds", "noise"},
    {"focus", "segmentation", "margin"},
    {"lights", "environment"},
};

bool isDecided(const std::string& name, const FlagValues& given) {
  const auto has = [&](const std::string& flag) { return given.has(flag); };
  for (const std::vector<std::string>& kind : kinds)
    if (std::find(kind.begin(), kind.end(), name) != kind.end())
      return std::any_of(kind.begin(), kind.end(), has);
  return has(name);
}

} // namespace

FlagValues withSceneFlags(const FlagValues& given) {
  FlagValues merged = given;
  const std::filesystem::path input = *given.text("INPUT");
  if (!isSceneFile(input))
    return merged;
  const MrmlScene scene(input);
  const std::vector<const MrmlNode*> nodes = scene.document.withTag("FenestraRender");
  if (nodes.empty())
    return merged;
  const MrmlNode& node = *nodes.back();
  const FlagValues deciding = withPreset(given).flags;
  for (const Flag& flag : renderSyntax.flags) {
    const std::string name = flag.name;
    const bool isNode = name == "volume" || name == "segmentation";
    const std::string value = isNode ? node.referenced(name) : node.text(name);
    if (shapesPicture(flag) && !value.empty() && !isDecided(name, deciding))
      merged.add(name, value);
  }
  if (!merged.has("focus") && !given.has("segmentation")) // which one was chosen does not matter
    merged.remove("segmentation");
  return merged;
}

std::vector<std::string> sceneArguments(const FlagValues& given, const FlagValues& merged) {
  const std::vector<std::string> before = given.arguments();
  std::vector<std::string> stored;
  for (const std::string& argument : merged.arguments())
    if (std::find(before.begin(), before.end(), argument) == before.end())
      stored.push_back(argument);
  return stored;
}

} // namespace fenestra
