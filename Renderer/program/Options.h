#pragma once
// Command-line options as data. One table serves --help, the man page, shell completions, parsing,
// Slicer's XML, and the merge with options stored in scenes and presets.

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

namespace fenestra::core {

class OptionValues;

/// Type, range and default of an option's value, and the variable that receives it.
struct ValueSpec {
  std::string type = "string";                   ///< Slicer's name; empty: not in Slicer's panel
  std::string channel = {};                      ///< of a file: "input" or "output"
  std::string image = {};                        ///< of an image: "label" or "vector"
  std::string extensions = {};                   ///< of an output file
  double least = -infinity, greatest = infinity; ///< range of a number
  std::vector<std::string> choices = {};         ///< all values of an enumeration; empty: free
  std::vector<std::string> namedValues = {};     ///< some valid values of a free text or number
  std::string defaultValue = {}; ///< default, shown in the help and in Slicer's panel; empty: none
  std::map<std::string, std::string> aliases = {}; ///< values of version 0.1, not shown: new ones
  bool canRepeat = false;                          ///< each occurrence adds one text
  std::optional<double> noEffectValue = {}; ///< number that has no effect, with any other options
  /// Stores a given value in its variable; empty: the command looks up the value by name.
  std::function<void(const OptionValues&, const std::string& name)> store = {};

  static ValueSpec text() { return {}; } ///< validated by its user
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
  /// A number, or "auto" (the default), which resets `target`.
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
  /// One choice per value of `target`. The default is the current value of `target`.
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

  /// Stores into `target`, which must outlive the result. Its current value becomes the default.
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
  /// Calls `read(options, name, target)`, for values with a syntax of their own.
  template <typename Target, typename Read>
  ValueSpec bind(Target& target, Read read) const {
    ValueSpec spec = *this;
    spec.store = [&target, read](const OptionValues& options, const std::string& name) {
      read(options, name, target);
    };
    return spec;
  }
  /// Adds named values, such as presets, to free text.
  ValueSpec withNamedValues(std::vector<std::string> known) const {
    ValueSpec spec = *this;
    spec.namedValues = std::move(known);
    return spec;
  }
  /// Accepts former spellings of values, in pairs of the old and the new one.
  ValueSpec withAliases(std::map<std::string, std::string> former) const {
    ValueSpec spec = *this;
    spec.aliases = std::move(former);
    return spec;
  }
  /// Replaces the displayed default; empty: none.
  ValueSpec withDefault(const std::string& text) const {
    ValueSpec spec = *this;
    spec.defaultValue = text;
    return spec;
  }
};

/// A given option replaces all options of its group that a scene stores; in `own`, only itself. The
/// options of a subgroup are alternatives: a given one replaces all of them that a preset sets.
enum class OverrideGroup {
  own,
  focus,
  clip,
  boundary, ///< subgroup of clip
  view,
  viewpoint, ///< subgroup of view
  extent,    ///< subgroup of view
  materials,
  lights,
  stop,
  process ///< files and execution: never stored in a scene, since the image does not depend on them
};

/// Group of a subgroup; any other group itself.
constexpr OverrideGroup parentGroup(OverrideGroup group) {
  using enum OverrideGroup;
  if (group == boundary)
    return clip;
  return group == viewpoint || group == extent ? view : group;
}

/// What an option requires to have an effect: a focus, any clip, labels (a focus or materials), or
/// one kind of clip. Without it the option is rejected.
enum class Requires { nothing, focus, labels, clip, plane, hole, ghost, surface, spline, exact };

/// Names of an option. Every place that reads names (command line, scenes, presets, tables) accepts
/// all long ones; values are stored under the canonical one.
struct OptionNames {
  std::string name;    ///< canonical: lower-case words joined by "-"
  std::string oneWord; ///< spelling of version 0.1 and of Slicer, whose parser accepts no "-"
  char letter = 0;     ///< of the short form, as 'o' in "-o"; 0: none

  /// `formerName`: that in version 0.1, unless it was `canonical` without "-".
  OptionNames(const char* canonical, const char* formerName);
  OptionNames(const char* canonical, char shortForm = 0) : OptionNames(canonical, "") {
    letter = shortForm;
  }

  bool hasName(std::string_view given) const;
};

struct Option : OptionNames {
  std::string placeholder; ///< placeholder in the help, such as FILE; empty: a switch
  std::string group;       ///< heading in the help; empty: not in the help
  std::string description; ///< one sentence; a final "[…]" describes the default
  ValueSpec spec = {};
  OverrideGroup overrideGroup = OverrideGroup::own;
  Requires requirement = Requires::nothing;

  bool isSwitch() const { return placeholder.empty(); }
  /// True if the value names an output file.
  bool isOutputFile() const { return spec.channel == "output"; }
  /// True if the value may name a file.
  bool canNameFile() const { return placeholder.find("FILE") != std::string::npos; }
  /// Description and default: "… [50]".
  std::string help() const;
  /// The value, or the new spelling of one from version 0.1.
  std::string resolveAlias(const std::string& value) const;
};

struct Positional {
  std::string name;
  std::string description;               ///< one sentence of help
  std::vector<std::string> choices = {}; ///< all values; empty: a file name
  bool canRepeat = false;                ///< only for the last: may occur several times
};

/// Options that are in a command's table, which other commands share, but that it rejects.
struct ExcludedOptions {
  std::vector<std::string> names;
  std::string reason; ///< second half of the error message: reason and hint
};

struct CommandSyntax {
  std::string name;
  std::string summary;
  std::vector<Positional> positionals; ///< all required, in order
  std::span<const Option> options;     ///< including `excluded`
  std::vector<ExcludedOptions> excluded = {};
  std::string brief = {};   ///< what it does, in one line of at most 64 characters
  std::string example = {}; ///< arguments of a typical call, after "fenestra"
};

/// Option values as given by the user, by canonical name. Accessors throw Error (usage) for invalid
/// values. Those that return no std::optional require that the option was given.
class OptionValues {
public:
  explicit OptionValues(std::span<const Option> options) : m_options(options) {}

  bool has(const std::string& name) const { return m_values.contains(name); }
  /// True if the option was given with a value other than its default.
  bool hasNonDefault(const std::string& name) const;
  std::optional<std::string> text(const std::string& name) const;
  /// Finite number in the option's range.
  std::optional<double> number(const std::string& name) const;
  /// As number(); nullopt: "auto".
  std::optional<double> numberOrAuto(const std::string& name) const;
  /// True if the value is ValueSpec::noEffectValue.
  bool hasNoEffect(const std::string& name) const;
  std::optional<std::uint64_t> integer(const std::string& name) const;
  /// Exactly `size` finite numbers, separated by commas.
  std::vector<double> numbers(const std::string& name, std::size_t size) const;
  Vec3 triple(const std::string& name) const;
  /// One of the option's choices; any text if it has none.
  std::string word(const std::string& name) const;
  /// All values of a repeatable option; empty: not given.
  std::vector<std::string> texts(const std::string& name) const;
  /// All values of a repeatable option, split at commas; "\," is a literal comma.
  std::vector<std::string> list(const std::string& name) const;
  /// Reads a given value according to the type of `target`.
  template <typename Target>
  void read(const std::string& name, Target& target) const {
    if constexpr (std::is_same_v<Target, std::vector<std::string>>)
      target = list(name);
    else if constexpr (std::is_same_v<Target, std::vector<std::filesystem::path>>)
      std::ranges::copy(texts(name), std::back_inserter(target));
    else if constexpr (std::is_integral_v<Target> ||
                       std::is_same_v<Target, std::optional<std::size_t>>)
      target = static_cast<Target>(*integer(name));
    else if constexpr (std::is_assignable_v<Target&, Vec3>)
      target = triple(name);
    else if constexpr (std::is_assignable_v<Target&, std::string>)
      target = word(name);
    else
      target = *number(name);
  }

  /// All given values, one line "name: value" each.
  std::string echo() const;
  /// All given values as command-line arguments.
  std::vector<std::string> arguments() const;

  void add(const std::string& name, const std::string& value) { m_values[name].push_back(value); }
  void remove(const std::string& name) { m_values.erase(name); }

private:
  const Option& option(const std::string& name) const;

  std::span<const Option> m_options;
  std::map<std::string, std::vector<std::string>> m_values;
};

/// Option with that long name; nullptr: none.
const Option* findOption(std::span<const Option> options, std::string_view name);
/// Option with that short form; nullptr: none.
const Option* findOption(std::span<const Option> options, char letter);

/// Argument of a command line that names an option.
struct OptionWord {
  const Option* option;
  std::optional<std::string_view> value; ///< in the same argument
};
/// Parses "--name", "--name=value", "-x", or "-x4" of an integer; nullopt: anything else.
std::optional<OptionWord> parseOptionWord(std::span<const Option> options, std::string_view word);

} // namespace fenestra::core
