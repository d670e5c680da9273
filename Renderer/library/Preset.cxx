// Presets of organs as options of a scene. A preset states options of the command line: those that
// its view, clip and appearance need have members here.

#include "library/Data.h"

#include <algorithm>
#include <variant>

namespace fenestra {
inline namespace v1 {
namespace {

using Member =
    std::variant<std::optional<std::string>*, std::optional<double>*, std::optional<Vector3>*>;

struct PresetOption {
  const char* name;
  Member member;
  bool isOverridden = false; ///< by another option with a value
};

std::vector<PresetOption> listOptions(SceneOptions& options) {
  View& view = options.view;
  Appearance& appearance = options.appearance;
  const bool isPlaced = view.name || view.position;
  const bool hasExtent = view.projection || view.scale || view.angle;
  const bool hasNoFocus = options.focus.empty(); // then segments have no effect
  return {{"view", &view.name, isPlaced},
          {"position", &view.position, isPlaced},
          {"target", &view.target},
          {"up", &view.up},
          {"scale", &view.scale, hasExtent},
          {"angle", &view.angle, hasExtent},
          {"label-smoothing", &options.labelSmoothing, hasNoFocus},
          {"clip-softness", &options.clip.softness, hasNoFocus},
          {"context-saturation", &appearance.contextSaturation, hasNoFocus},
          {"materials", &appearance.materials, hasNoFocus},
          {"transfer", &appearance.transfer},
          {"lights", &appearance.lights}};
}

/// Sets a member that has no value. False if the text is none of its type.
bool setMember(const Member& member, const std::string& text) {
  if (const auto* const word = std::get_if<std::optional<std::string>*>(&member)) {
    **word = (*word)->value_or(text);
    return true;
  }
  const auto* const position = std::get_if<std::optional<Vector3>*>(&member);
  const std::vector<std::string> parts = core::split(text, ',');
  Vector3 numbers = {};
  if (parts.size() != (position ? numbers.size() : 1))
    return false;
  for (std::size_t i = 0; i < parts.size(); ++i)
    if (const auto number = core::parseNumber<double>(parts[i]))
      numbers[i] = *number;
    else
      return false;
  if (position)
    **position = (*position)->value_or(numbers);
  else if (auto& number = *std::get<std::optional<double>*>(member); !number)
    number = numbers[0];
  return true;
}

} // namespace

std::optional<core::Modality> applyPreset(const core::ChosenPreset& chosen, SceneOptions& options) {
  const core::OrganPreset& preset = chosen.preset;
  const bool hasTransfer = options.appearance.transfer.has_value();
  options.focus = chosen.focus;
  const std::vector<PresetOption> known = listOptions(options);
  for (const auto& [name, value] : preset.options) {
    const auto option = std::ranges::find(known, name, &PresetOption::name);
    if (option == known.end())
      throw core::fieldError(preset.name, "flags", '"', name,
                             "\" is an option of the command line alone");
    if (!option->isOverridden && !setMember(option->member, value))
      throw core::fieldError(preset.name, "flags", '"', name, "\" has an invalid value");
  }
  const bool setsTransfer = !hasTransfer && options.appearance.transfer;
  return setsTransfer ? std::optional(preset.modality) : std::nullopt;
}

} // namespace v1
} // namespace fenestra
