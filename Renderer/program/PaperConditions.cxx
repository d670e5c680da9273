#include "program/PaperConditions.h"

#include "base/Text.h"

#include <algorithm>

namespace fenestra::core {
namespace {

/// What an option needs to have an effect.
enum class Needs { nothing, labels, focus, surface, spline };

struct Condition {
  const char* name;
  const char* value;
  Needs needs;
};

constexpr Condition conditions[] = {
    {"clip-boundary", "spline", Needs::surface},

    {"control-points", "50", Needs::spline},
    {"spline-smoothing", "0.5", Needs::spline},
    {"clip-softness", "0", Needs::focus},
    {"label-smoothing", "0", Needs::labels},
    {"margin", "0", Needs::focus},
    {"materials", "none", Needs::nothing},
    {"context-saturation", "1", Needs::focus},
    {"context-density", "1", Needs::focus},
    {"gradient", "central", Needs::nothing},
    {"volume-smoothing", "off", Needs::nothing},
    {"table", "keep", Needs::nothing},
};

bool hasWord(const OptionValues& values, const std::string& name,
             const std::vector<std::string>& words) {
  return !values.has(name) || std::ranges::count(words, *values.text(name)) > 0;
}

bool meets(const OptionValues& values, Needs needs) {
  if (needs == Needs::nothing)
    return true;
  if (needs == Needs::labels)
    return values.has("focus") || !hasWord(values, "materials", {"none"});
  if (needs == Needs::focus || !values.has("focus"))
    return values.has("focus");
  if (!hasWord(values, "clip", {"auto", "surface", "ghost"}))
    return false;
  return needs == Needs::surface || hasWord(values, "clip-boundary", {"spline"});
}

} // namespace

std::string describePaperConditions() {
  const auto describe = [](const Condition& one) { return concat("--", one.name, ' ', one.value); };
  return concat(
      "Renders under the conditions of the paper, with equal optical properties for focus "
      "and context and without smoothing: ",
      join(conditions, " ", describe), "; other options override them");
}

bool isPaperCondition(const std::string& name) {
  return std::ranges::any_of(conditions, [&](const Condition& one) { return name == one.name; });
}

OptionValues addPaperConditions(OptionValues values,
                                const std::function<bool(const std::string& name)>& isGiven) {
  if (!values.has("paper"))
    return values;
  for (const Condition& one : conditions)
    if (!isGiven(one.name) && meets(values, one.needs)) {
      values.remove(one.name);
      values.add(one.name, one.value);
    }
  return values;
}

} // namespace fenestra::core
