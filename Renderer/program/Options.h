#pragma once
// Flags as data: one table, read by --help, by parsing, by Slicer's description, and where a
// scene's or a preset's flags meet those of the command line.

#include "base/Text.h"
#include "base/Vector.h"

#include <algorithm>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace fenestra {

class OptionValues;

/// Values that a flag accepts, its default, and where the value goes.
struct ValueSpec {
  std::string type = "string";                   ///< Slicer's name; empty: not in Slicer's panel
  std::string channel = {};                      ///< of a file: "input", or "output" if written
  std::string image = {};                        ///< of an image: "label" or "vector"
  std::string extensions = {};                   ///< of a file that is written
  double least = -infinity, greatest = infinity; ///< range of a number
  std::vector<std::string> choices = {};         ///< values, if not empty
  std::vector<std::string> namedValues = {};     ///< some of the values of a flag without `words`
  std::string defaultValue = {}; ///< default, shown in the help and in Slicer's panel; empty: none
  bool canRepeat = false;        ///< may be given several times, each value one by itself (texts)
  std::optional<double> noEffectValue = {}; ///< number that changes nothing, whatever else is given
  /// Puts a given value into its place; empty: the command asks for the value by name.
  std::function<void(const OptionValues&, const std::string& name)> store = {};

  static ValueSpec text() { return {}; } ///< checked by the code that uses it
  static ValueSpec texts() { return {.canRepeat = true}; }
  static ValueSpec list() { return {"string-vector"}; }
  static ValueSpec numbers() { return {"double-vector"}; }
  static ValueSpec labels() { return {"image", "input", "label"}; }
  static ValueSpec outputImage() { return {"image", "output", "vector", ".nrrd"}; }
  static ValueSpec surface() { return {"file", "output", "", ".vtp,.ply,.stl"}; }
  static ValueSpec jsonFile() { return {"file", "output", "", ".json"}; }
  static ValueSpec checkpointFile() { return {"file", "output", "", ".film"}; }
  static ValueSpec notInPanel() { return {""}; }
  static ValueSpec number(double least, double greatest) {
    return {"double", "", "", "", least, greatest};
  }
  static ValueSpec integer(double least, double greatest) {
    return {"integer", "", "", "", least, greatest};
  }
  /// A number, or the word auto, which leaves `place` empty and is the default.
  static ValueSpec numberOrAuto(std::optional<double>& target, double least, double greatest,
                                double noEffectValue) {
    ValueSpec spec = ValueSpec{.least = least,
                               .greatest = greatest,
                               .namedValues = {"auto"},
                               .defaultValue = "auto",
                               .noEffectValue = noEffectValue};
    return spec.bind(target, [](const auto& options, const auto& name, auto& at) {
      at = options.numberOrAuto(name);
    });
  }
  static ValueSpec choice(std::vector<std::string> words) {
    return {.type = "string-enumeration", .choices = std::move(words)};
  }
  /// A word for each value of `place`, where it goes; the place's present value is the default.
  template <typename Target>
  static ValueSpec
  choice(Target& target,
         const std::vector<std::pair<std::string, std::type_identity_t<Target>>>& values) {
    ValueSpec spec =
        choice({}).bind(target, [values](const auto& options, const auto& name, Target& at) {
          const std::string given = options.word(name);
          at = std::ranges::find(values, given, &std::pair<std::string, Target>::first)->second;
        });
    for (const auto& [word, value] : values) {
      spec.choices.push_back(word);
      if (value == target)
        spec.defaultValue = word;
    }
    return spec;
  }

  /// Place of the value, which must outlive `put`. The default is its present number or text.
  template <typename Target>
  ValueSpec bind(Target& target) const {
    ValueSpec spec = bind(
        target, [](const auto& options, const auto& name, Target& at) { options.read(name, at); });
    if constexpr (std::is_arithmetic_v<Target>)
      spec.defaultValue = toString(static_cast<double>(target));
    else if constexpr (std::is_same_v<Target, std::string>)
      spec.defaultValue = target;
    return spec;
  }
  /// Place that `read(flags, name, place)` fills, for values of a form of their own.
  template <typename Target, typename Read>
  ValueSpec bind(Target& target, Read read) const {
    ValueSpec spec = *this;
    spec.store = [&target, read](const OptionValues& options, const std::string& name) {
      read(options, name, target);
    };
    return spec;
  }
  /// Names that stand for values, beside other values.
  ValueSpec withNamedValues(std::vector<std::string> known) const {
    ValueSpec spec = *this;
    spec.namedValues = std::move(known);
    return spec;
  }
  /// Default to be shown instead; empty: none.
  ValueSpec withDefault(const std::string& text) const {
    ValueSpec spec = *this;
    spec.defaultValue = text;
    return spec;
  }
};

/// Topic of a flag. A given flag replaces all flags of its topic that a scene stores; `own`: itself
/// alone. A part of a topic holds alternatives: a given one replaces all that a preset sets.
enum class OverrideGroup {
  own,
  focus,
  clip,
  boundary, ///< part of clip
  view,
  viewpoint, ///< part of view
  extent,    ///< part of view
  materials,
  lights,
  stop,
  process ///< files, and how the program works: stored in no scene, for it shapes no picture
};

/// Topic that a part belongs to; else the topic itself.
constexpr OverrideGroup parentGroup(OverrideGroup group) {
  using enum OverrideGroup;
  if (group == boundary)
    return clip;
  return group == viewpoint || group == extent ? view : group;
}

/// Things without which a flag has no effect, and is refused: a focus, any clip, labels (of a
/// focus or of materials), or a kind of clip.
enum class Requires { nothing, focus, labels, clip, plane, hole, ghost, surface, spline };

struct Option {
  std::string name;        ///< one lower-case word, without dashes
  std::string placeholder; ///< placeholder in the help, such as FILE; empty: a switch
  std::string group;       ///< heading in the help
  std::string description; ///< one sentence of help; "[…]" at its end: a default in words
  ValueSpec spec = {};
  OverrideGroup overrideGroup = OverrideGroup::own;
  Requires requirement = Requires::nothing;

  bool isSwitch() const { return placeholder.empty(); }
  /// True if the value names a file to be written.
  bool isOutputFile() const { return spec.channel == "output"; }
  /// True if the value may name a file.
  bool canNameFile() const { return placeholder.find("FILE") != std::string::npos; }
  /// Sentence of help with the default, "… [50]".
  std::string help() const;
};

struct Positional {
  std::string name;
  std::string description;               ///< one sentence of help
  std::vector<std::string> choices = {}; ///< values; empty: it names a file
  bool canRepeat = false;                ///< the last may be given several times
};

/// Flags of another command that this one shares its table with, but does not take.
struct ExcludedOptions {
  std::vector<std::string> names;
  std::string reason; ///< and what to do; the rest of the message
};

struct CommandSyntax {
  std::string name;
  std::string summary;
  std::vector<Positional> positionals; ///< all required, in order
  std::span<const Option> options;     ///< those refused, too
  std::vector<ExcludedOptions> excluded = {};
};

/// Flag values as the user gave them. Accessors throw Error (usage) for values that the flag does
/// not take; those without "optional" are for flags that are given.
class OptionValues {
public:
  explicit OptionValues(std::span<const Option> options) : m_options(options) {}

  bool has(const std::string& name) const { return m_values.contains(name); }
  /// True if the flag was given with another value than its default.
  bool hasNonDefault(const std::string& name) const;
  std::optional<std::string> text(const std::string& name) const;
  /// Finite number in the flag's range.
  std::optional<double> number(const std::string& name) const;
  /// The same; nothing for auto.
  std::optional<double> numberOrAuto(const std::string& name) const;
  /// True for a flag's value that changes nothing (Takes::idle).
  bool hasNoEffect(const std::string& name) const;
  std::optional<std::uint64_t> integer(const std::string& name) const;
  /// Exactly `size` finite numbers, separated by commas.
  std::vector<double> numbers(const std::string& name, std::size_t size) const;
  Vec3 triple(const std::string& name) const;
  /// One of the flag's words; any text if it has none.
  std::string word(const std::string& name) const;
  /// All values of a repeatable flag; empty: not given.
  std::vector<std::string> texts(const std::string& name) const;
  /// All values of a repeatable flag, split at commas; "\," is a comma.
  std::vector<std::string> list(const std::string& name) const;
  /// Reads a given flag as the place's type asks.
  template <typename Target>
  void read(const std::string& name, Target& target) const {
    if constexpr (std::is_same_v<Target, std::vector<std::string>>)
      target = list(name);
    else if constexpr (std::is_same_v<Target, std::vector<std::filesystem::path>>)
      std::ranges::copy(texts(name), std::back_inserter(target));
    else if constexpr (std::is_integral_v<Target>)
      target = static_cast<Target>(*integer(name));
    else if constexpr (std::is_assignable_v<Target&, Vec3>)
      target = triple(name);
    else if constexpr (std::is_assignable_v<Target&, std::string>)
      target = word(name);
    else
      target = *number(name);
  }

  /// All given values, "name: value" a line.
  std::string echo() const;
  /// All given values as arguments of a command line.
  std::vector<std::string> arguments() const;

  void add(const std::string& name, const std::string& value) { m_values[name].push_back(value); }
  void remove(const std::string& name) { m_values.erase(name); }

private:
  const Option& option(const std::string& name) const;

  std::span<const Option> m_options;
  std::map<std::string, std::vector<std::string>> m_values;
};

/// Flag with that name; null: none.
const Option* findOption(std::span<const Option> options, std::string_view name);

} // namespace fenestra
