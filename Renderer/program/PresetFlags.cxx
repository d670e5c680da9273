#include "program/PresetFlags.h"

#include "base/Error.h"
#include "session/Defaults.h"
#include "session/NamedLooks.h"
#include "session/OrganPresets.h"

#include <algorithm>

namespace fenestra {
namespace {

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
  throw inputError(source,
                   "flags: \"" + name + "\" is no flag of clipping, view or look; remove it");
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
                                    "a preset and give --focus A,B,...");
  std::vector<OrganPreset> presets;
  for (const std::string& own : ownPresets("presets"))
    presets.push_back(namedPreset(own));
  return fittingPreset(presets, inFocus(given, names->segments), names->source,
                       [&](Modality modality) {
                         return suits(modality, input.volume(given.text("volume")).volume);
                       });
}

/// Escapes commas in an id, as --focus expects.
std::string escaped(const std::string& id) {
  std::string text;
  for (const char c : id)
    text += c == ',' ? std::string("\\,") : std::string(1, c);
  return text;
}

void addFocus(const OrganPreset& preset, const SegmentNames& names, FlagValues& flags) {
  if (names.segments.empty())
    throw inputError(names.source, "--preset " + preset.name +
                                       ": its segments have no names, only values; say which are "
                                       "meant with --focus A,B,...");
  const std::vector<SegmentInfo> focus = focusOf(preset.focus, names.segments);
  if (focus.empty())
    throw inputError(names.source, "--preset " + preset.name + ": none of its segments is one (" +
                                       listedNames(names.segments) +
                                       "); give --focus A,B,..., or another preset");
  for (const SegmentInfo& segment : focus)
    flags.add("focus", escaped(segment.id));
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

} // namespace fenestra
