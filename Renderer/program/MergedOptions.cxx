#include "program/MergedOptions.h"

#include "base/Error.h"
#include "files/images/ImageFormat.h"
#include "files/slicer/MrmlScene.h"
#include "io/MessageText.h"
#include "program/PaperConditions.h"
#include "program/UsageError.h"
#include "scene/NamedPresets.h"
#include "scene/OrganPresets.h"

#include <algorithm>
#include <cstdio>

namespace fenestra::core {
namespace {

// ---- options of an organ preset

/// False for a default passed by Slicer, whose panel passes every option.
bool isGiven(const OptionValues& given, const std::string& name) {
  return given.has("returnparameterfile") ? given.hasNonDefault(name) : given.has(name);
}

/// True if given options override the preset's option `own`.
bool isOverridden(const Option& own, const OptionValues& given) {
  return std::ranges::any_of(renderSyntax.options, [&](const Option& option) {
    const bool isAlternative = option.overrideGroup == own.overrideGroup &&
                               parentGroup(own.overrideGroup) != own.overrideGroup;
    const bool isMode =
        option.name == "clip" && parentGroup(own.overrideGroup) == OverrideGroup::clip;
    return (option.name == own.name || isAlternative || isMode) && isGiven(given, option.name);
  });
}

/// Option that a preset sets. Throws Error (input) if presets may not set it; a preset may be a
/// user's file.
const Option& findPresetOption(const std::string& name, const std::string& source) {
  if (const Option* option = findOption(renderSyntax.options, name);
      option && isAppearanceOption(*option))
    return *option;
  throw inputError(source, "flags: \"", name,
                   "\" is not an option of clipping, view or appearance; remove it");
}

// ---- options of a scene

/// True if given options replace a stored one: the same option, or another one of its group.
bool isReplaced(const Option& own, const OptionValues& given) {
  return std::ranges::any_of(renderSyntax.options, [&](const Option& option) {
    const bool isInGroup = parentGroup(option.overrideGroup) == parentGroup(own.overrideGroup);
    return (option.name == own.name || (isInGroup && own.overrideGroup != OverrideGroup::own)) &&
           given.has(option.name);
  });
}

/// True if a render would open a file that the value names.
bool isFile(const std::string& name, const std::string& value, const Input& input) {
  if (name == "environment")
    return findImageFormat(value) == ImageFormat::exr;
  if (name == "preset")
    return isFileName("presets", value);
  if (name == "lights")
    return isLightsFile(value);
  if (name == "materials")
    return isMaterialsFile(value);
  return name == "transfer" && isTransferFile(value, input);
}

/// True for values beyond the limits of a scene. A text that is no number is rejected later, as on
/// the command line.
bool isBeyondLimit(const std::string& name, const std::string& value) {
  constexpr int mostPixels = 4096; // for width and height
  constexpr std::uint64_t mostSamples = 65536;
  int width = 0, height = 0;
  if (name == "size" && std::sscanf(value.c_str(), "%dx%d", &width, &height) == 2)
    return std::max(width, height) > mostPixels;
  if (name != "samples")
    return false;
  OptionValues samples(renderSyntax.options);
  samples.add(name, value);
  return samples.integer(name) > mostSamples;
}

/// Value of the attribute with one of the option's names; empty: none.
std::string findStoredValue(const MrmlNode& node, const Option& option) {
  const std::string value = node.text(option.name);
  return value.empty() ? node.text(option.oneWord) : value;
}

/// Adds a stored value. A repeatable option stores its values separated by commas ("\," is a
/// literal comma).
void addStoredValue(const Option& option, const std::string& value, OptionValues& merged) {
  if (!option.spec.canRepeat)
    return merged.add(option.name, value);
  OptionValues stored(renderSyntax.options);
  stored.add(option.name, value);
  for (const std::string& one : stored.list(option.name))
    merged.add(option.name, one);
}

/// Reason why a scene's stored value is ignored; empty: it is used.
std::string findRejectionReason(const Input& input, const std::string& name,
                                const std::string& value) {
  if (name == "volume" || name == "segmentation")
    return input.document()->find(value) ? "" : "is no node of the scene";
  if (isBeyondLimit(name, value))
    return "is beyond the limit for scenes";
  return isFile(name, value, input) ? "names a file, which a scene must not do" : "";
}

} // namespace

PresetOptions mergePreset(const OptionValues& given, const Input& input) {
  const auto isExplicit = [&given](const std::string& name) { return isGiven(given, name); };
  const std::optional<std::string> name = given.text("preset");
  if (!name)
    return {addPaperConditions(given, isExplicit)};
  PresetOptions result{given};
  OptionValues& values = result.values;
  const InputChoice choice = {given.text("volume"), given.text("segmentation"),
                              given.text("labels"), given.list("focus")};
  const auto [preset, focus] =
      chooseOrganPreset(given.word("preset"), input, choice, readVolumeChoice(given));
  if (!given.has("focus"))
    for (const std::string& selector : focus)
      values.add("focus", replaceAll(selector, ",", "\\,"));
  values = addPaperConditions(values, isExplicit);
  const OptionValues preferred = values;
  for (const auto& [optionName, value] : preset.options) {
    const Option& option = findPresetOption(optionName, *name);
    if (isOverridden(option, preferred) ||
        (!values.has("focus") &&
         (isClipOption(option) || option.overrideGroup == OverrideGroup::materials)))
      continue;
    values.remove(option.name);
    values.add(option.name, value);
    if (option.name == "transfer")
      result.transferModality = preset.modality;
  }
  values.remove("preset");
  values.add("preset", preset.name);
  return result;
}

RenderOptions makeRenderOptions(const PresetOptions& merged) {
  RenderOptions options = makeRenderOptions(merged.values);
  options.scene.transferModality = merged.transferModality;
  return options;
}

SceneOptions mergeSceneOptions(const OptionValues& given, const Input& input) {
  SceneOptions result{given};
  OptionValues& merged = result.values;
  const MrmlDocument* scene = input.document();
  const auto nodes = scene ? scene->findByTag("FenestraRender") : std::vector<const MrmlNode*>();
  if (nodes.empty())
    return result;
  const MrmlNode& node = *nodes.back();
  const OptionValues explicitValues = mergePreset(given, input).values;
  for (const Option& option : renderSyntax.options) {
    const std::string& name = option.name;
    const bool isNode = name == "volume" || name == "segmentation";
    const std::string value =
        isNode ? node.referenceId(name) : option.resolveAlias(findStoredValue(node, option));
    if (!isImageOption(option) || value.empty() || isReplaced(option, explicitValues) ||
        (given.has("paper") && isPaperCondition(name)))
      continue;
    if (const std::string reason = findRejectionReason(input, name, value); reason.empty())
      addStoredValue(option, value, merged);
    else
      result.ignored.push_back(concat(node.tag, ' ', describeNode(node), ": ", name, " \"",
                                      sanitize(value), "\" ", reason, "; to use it, add --", name,
                                      ' ', sanitize(value)));
  }
  const bool hasMaterials = merged.text("materials").value_or(noMaterials) != noMaterials;
  if (!hasMaterials && !given.has("material")) // changes of materials that were ignored
    merged.remove("material");
  const bool usesLabels = merged.has("focus") || hasMaterials;
  if (!usesLabels && !given.has("segmentation")) // the stored choice has no effect
    merged.remove("segmentation");
  return result;
}

} // namespace fenestra::core
