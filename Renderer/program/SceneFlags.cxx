#include "program/SceneFlags.h"

#include "base/TextStream.h"
#include "base/safe/ShownText.h"
#include "files/pictures/ImageFormat.h"
#include "files/slicer/MrmlScene.h"
#include "program/PresetFlags.h"
#include "session/NamedLooks.h"

#include <algorithm>
#include <cstdio>

namespace fenestra {
namespace {

/// True if given flags replace a stored one: itself, or another of its topic.
bool isReplaced(const Flag& stored, const FlagValues& given) {
  return std::ranges::any_of(renderSyntax.flags, [&](const Flag& flag) {
    const bool isOfTopic = wholeOf(flag.topic) == wholeOf(stored.topic);
    return (flag.name == stored.name || (isOfTopic && stored.topic != Topic::own)) &&
           given.has(flag.name);
  });
}

/// True if a render would open a file that the value names.
bool isFile(const std::string& name, const std::string& value, const Input& input) {
  if (name == "environment")
    return imageFormat(value) == ImageFormat::exr;
  if (name == "preset")
    return isFileName("presets", value);
  if (name == "lights")
    return isFileOfLights(value);
  return name == "transfer" && isFileOfTransfer(value, input);
}

/// True beyond the limits of a scene's flags. A text that is no number is refused later, like one
/// that a user gave.
bool isTooMuch(const std::string& name, const std::string& value) {
  constexpr int mostPixels = 4096; // limit of width and of height
  constexpr std::uint64_t mostSamples = 65536;
  int width = 0, height = 0;
  if (name == "size" && std::sscanf(value.c_str(), "%dx%d", &width, &height) == 2)
    return std::max(width, height) > mostPixels;
  if (name != "samples")
    return false;
  FlagValues samples(renderSyntax.flags);
  samples.add(name, value);
  return samples.count(name) > mostSamples;
}

/// Reason why a scene's stored value is not taken; empty: taken.
std::string objection(const Input& input, const std::string& name, const std::string& value) {
  if (name == "volume" || name == "segmentation")
    return input.document()->find(value) ? "" : "is no node of the scene";
  if (isTooMuch(name, value))
    return "is more than a scene may ask for";
  return isFile(name, value, input) ? "names a file, which a scene may not choose" : "";
}

std::string leftOut(const MrmlNode& node, const std::string& name, const std::string& value,
                    const std::string& why) {
  TextWriter line;
  line << node.tag << ' ' << shown(node) << ": " << name << " \"" << value << "\" " << why
       << "; give --" << name << ' ' << value;
  return line.str();
}

} // namespace

SceneFlags withSceneFlags(const FlagValues& given, const Input& input) {
  SceneFlags result{given};
  FlagValues& merged = result.flags;
  const MrmlDocument* scene = input.document();
  const auto nodes = scene ? scene->withTag("FenestraRender") : std::vector<const MrmlNode*>();
  if (nodes.empty())
    return result;
  const MrmlNode& node = *nodes.back();
  const FlagValues deciding = withPreset(given, input).flags;
  for (const Flag& flag : renderSyntax.flags) {
    const std::string& name = flag.name;
    const bool isNode = name == "volume" || name == "segmentation";
    const std::string value = isNode ? node.referenced(name) : node.text(name);
    if (!shapesPicture(flag) || value.empty() || isReplaced(flag, deciding))
      continue;
    if (const std::string why = objection(input, name, value); !why.empty())
      result.leftOut.push_back(leftOut(node, name, shown(value), why));
    else
      merged.add(name, value);
  }
  if (!merged.has("focus") && !given.has("segmentation")) // the stored choice does not matter
    merged.remove("segmentation");
  return result;
}

std::vector<std::string> sceneArguments(const FlagValues& given, const FlagValues& merged) {
  std::vector<std::string> stored = merged.arguments();
  std::erase_if(stored, [before = given.arguments()](const std::string& argument) {
    return std::ranges::find(before, argument) != before.end();
  });
  return stored;
}

} // namespace fenestra
