#include "program/MergedFlags.h"

#include "base/Error.h"
#include "base/safe/ShownText.h"
#include "files/pictures/ImageFormat.h"
#include "files/slicer/MrmlScene.h"
#include "session/Defaults.h"
#include "session/NamedLooks.h"
#include "session/OrganPresets.h"

#include <algorithm>
#include <cstdio>

namespace fenestra {
namespace {

// ---- an organ preset's flags

/// False for a default that Slicer hands over: its panel passes every flag.
bool isGiven(const FlagValues& given, const std::string& name) {
  return given.has("returnparameterfile") ? given.differs(name) : given.has(name);
}

/// True if given flags replace what the preset says of `own`.
bool isOverruled(const Flag& own, const FlagValues& given) {
  return std::ranges::any_of(renderSyntax.flags, [&](const Flag& flag) {
    const bool isAlternative = flag.topic == own.topic && wholeOf(own.topic) != own.topic;
    const bool isMode = flag.name == "clip" && wholeOf(own.topic) == Topic::clip;
    return (flag.name == own.name || isAlternative || isMode) && isGiven(given, flag.name);
  });
}

/// Flag that a preset sets. Throws Error (input) for one that it may not set: a preset may be a
/// user's file.
const Flag& presetFlag(const std::string& name, const std::string& source) {
  if (const Flag* flag = findFlag(renderSyntax.flags, name); flag && shapesLook(*flag))
    return *flag;
  throw inputError(source, "flags: \"", name, "\" is no flag of clipping, view or look; remove it");
}

/// Segments named by the given focus; all if it names none.
std::vector<SegmentInfo> inFocus(const FlagValues& given,
                                 const std::vector<SegmentInfo>& segments) {
  const std::vector<std::string> focus = given.list("focus");
  std::vector<SegmentInfo> named;
  std::ranges::copy_if(segments, std::back_inserter(named), [&](const SegmentInfo& segment) {
    const std::string names[] = {segment.id, segment.name, std::to_string(segment.labelValue)};
    return std::ranges::find_first_of(focus, names) != focus.end();
  });
  return named.empty() ? segments : named;
}

OrganPreset presetFor(const FlagValues& given, const Input& input,
                      const std::optional<SegmentNames>& names) {
  const std::string name = *given.text("preset");
  if (name != "auto")
    return namedPreset(name);
  if (!names)
    throw usageError("--preset auto: goes by the names of segments; add --segmentation FILE, or "
                     "name a preset");
  if (names->segments.empty())
    throw inputError(names->source, "--preset auto: its segments have no names, only values; name "
                                    "them with --labels, or name a preset and give --focus "
                                    "A,B,...");
  std::vector<OrganPreset> presets;
  for (const std::string& own : ownPresets("presets"))
    presets.push_back(namedPreset(own));
  return fittingPreset(presets, inFocus(given, names->segments), names->source,
                       [&](Modality modality) {
                         return suits(modality, input.volume(given.text("volume")).volume);
                       });
}

void addFocus(const OrganPreset& preset, const SegmentNames& names, FlagValues& flags) {
  if (names.segments.empty())
    throw inputError(names.source, "--preset ", preset.name,
                     ": its segments have no names, only values; name them with --labels, or say "
                     "which are meant with --focus A,B,...");
  const std::vector<SegmentInfo> focus = focusOf(preset.focus, names.segments);
  if (focus.empty())
    throw inputError(names.source, "--preset ", preset.name, ": none of its segments is one (",
                     listedNames(names.segments), "); give --focus A,B,..., or another preset");
  for (const SegmentInfo& segment : focus)
    flags.add("focus", replacedAll(segment.id, ",", "\\,"));
}

// ---- a scene's flags

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
  if (name == "materials")
    return isFileOfMaterials(value);
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

/// Adds a stored value; of a flag that may be repeated, values separated by commas ("\," is a
/// comma).
void addStored(const Flag& flag, const std::string& value, FlagValues& merged) {
  if (!flag.takes.repeats)
    return merged.add(flag.name, value);
  FlagValues stored(renderSyntax.flags);
  stored.add(flag.name, value);
  for (const std::string& one : stored.list(flag.name))
    merged.add(flag.name, one);
}

/// Reason why a scene's stored value is not taken; empty: taken.
std::string objection(const Input& input, const std::string& name, const std::string& value) {
  if (name == "volume" || name == "segmentation")
    return input.document()->find(value) ? "" : "is no node of the scene";
  if (isTooMuch(name, value))
    return "is more than a scene may ask for";
  return isFile(name, value, input) ? "names a file, which a scene may not choose" : "";
}

} // namespace

PresetFlags withPreset(const FlagValues& given, const Input& input) {
  PresetFlags result{given};
  if (!given.has("preset"))
    return result;
  const bool givenFocus = given.has("focus");
  const bool byNames = given.text("preset") == "auto" || !givenFocus;
  const auto names = byNames ? input.segmentNames({given.text("volume"), given.text("segmentation"),
                                                   given.text("labels")})
                             : std::nullopt;
  const OrganPreset preset = presetFor(given, input, names);
  FlagValues& flags = result.flags;
  if (!givenFocus && names)
    addFocus(preset, *names, flags);
  for (const auto& [name, value] : preset.flags) {
    const Flag& flag = presetFlag(name, *given.text("preset"));
    if (isOverruled(flag, given) || (shapesClip(flag) && !flags.has("focus")))
      continue;
    flags.remove(name);
    flags.add(name, value);
    if (name == "transfer")
      result.transferFor = preset.modality;
  }
  flags.remove("preset");
  flags.add("preset", preset.name);
  return result;
}

RenderOptions renderOptions(const PresetFlags& flags) {
  RenderOptions options = renderOptions(flags.flags);
  options.scene.transferFor = flags.transferFor;
  return options;
}

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
    if (const std::string why = objection(input, name, value); why.empty())
      addStored(flag, value, merged);
    else
      result.leftOut.push_back(textOf(node.tag, ' ', shown(node), ": ", name, " \"", shown(value),
                                      "\" ", why, "; give --", name, ' ', shown(value)));
  }
  const bool hasMaterials = merged.text("materials").value_or(noMaterials) != noMaterials;
  if (!hasMaterials && !given.has("material")) // changes of what was not taken
    merged.remove("material");
  const bool usesLabels = merged.has("focus") || hasMaterials;
  if (!usesLabels && !given.has("segmentation")) // the stored choice does not matter
    merged.remove("segmentation");
  return result;
}

} // namespace fenestra
