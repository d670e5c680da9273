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

class FlagValues;

/// Values that a flag accepts, its default, and where the value goes.
struct Takes {
  std::string type = "string";                   ///< Slicer's name; empty: not in Slicer's panel
  std::string channel = {};                      ///< of a file: "input", or "output" if written
  std::string image = {};                        ///< of an image: "label" or "vector"
  std::string extensions = {};                   ///< of a file that is written
  double least = -infinity, greatest = infinity; ///< range of a number
  std::vector<std::string> words = {};           ///< values, if not empty
  std::vector<std::string> names = {};           ///< some of the values of a flag without `words`
  std::string standard = {}; ///< default, shown in the help and in Slicer's panel; empty: none
  bool repeats = false;      ///< may be given several times, each value one by itself (texts)
  std::optional<double> idle = {}; ///< number that changes nothing, whatever else is given
  /// Puts a given value into its place; empty: the command asks for the value by name.
  std::function<void(const FlagValues&, const std::string& name)> put = {};

  static Takes text() { return {}; } ///< checked by the code that uses it
  static Takes texts() { return {.repeats = true}; }
  static Takes list() { return {"string-vector"}; }
  static Takes numbers() { return {"double-vector"}; }
  static Takes labels() { return {"image", "input", "label"}; }
  static Takes picture() { return {"image", "output", "vector", ".nrrd"}; }
  static Takes surface() { return {"file", "output", "", ".vtp,.ply,.stl"}; }
  static Takes report() { return {"file", "output", "", ".json"}; }
  static Takes film() { return {"file", "output", "", ".film"}; }
  static Takes slicersOwn() { return {""}; }
  static Takes number(double least, double greatest) {
    return {"double", "", "", "", least, greatest};
  }
  static Takes whole(double least, double greatest) {
    return {"integer", "", "", "", least, greatest};
  }
  /// A number, or the word auto, which leaves `place` empty and is the default.
  static Takes numberOrAuto(std::optional<double>& place, double least, double greatest,
                            double idle) {
    Takes takes = Takes{
        .least = least, .greatest = greatest, .names = {"auto"}, .standard = "auto", .idle = idle};
    return takes.into(place, [](const auto& flags, const auto& name, auto& at) {
      at = flags.numberOrAuto(name);
    });
  }
  static Takes word(std::vector<std::string> words) {
    return {.type = "string-enumeration", .words = std::move(words)};
  }
  /// A word for each value of `place`, where it goes; the place's present value is the default.
  template <typename Place>
  static Takes
  word(Place& place,
       const std::vector<std::pair<std::string, std::type_identity_t<Place>>>& values) {
    Takes takes = word({}).into(place, [values](const auto& flags, const auto& name, Place& at) {
      const std::string given = flags.word(name);
      at = std::ranges::find(values, given, &std::pair<std::string, Place>::first)->second;
    });
    for (const auto& [word, value] : values) {
      takes.words.push_back(word);
      if (value == place)
        takes.standard = word;
    }
    return takes;
  }

  /// Place of the value, which must outlive `put`. The default is its present number or text.
  template <typename Place>
  Takes into(Place& place) const {
    Takes takes =
        into(place, [](const auto& flags, const auto& name, Place& at) { flags.read(name, at); });
    if constexpr (std::is_arithmetic_v<Place>)
      takes.standard = numberText(static_cast<double>(place));
    else if constexpr (std::is_same_v<Place, std::string>)
      takes.standard = place;
    return takes;
  }
  /// Place that `read(flags, name, place)` fills, for values of a form of their own.
  template <typename Place, typename Read>
  Takes into(Place& place, Read read) const {
    Takes takes = *this;
    takes.put = [&place, read](const FlagValues& flags, const std::string& name) {
      read(flags, name, place);
    };
    return takes;
  }
  /// Names that stand for values, beside other values.
  Takes orNames(std::vector<std::string> known) const {
    Takes takes = *this;
    takes.names = std::move(known);
    return takes;
  }
  /// Default to be shown instead; empty: none.
  Takes shows(const std::string& text) const {
    Takes takes = *this;
    takes.standard = text;
    return takes;
  }
};

/// Topic of a flag. A given flag replaces all flags of its topic that a scene stores; `own`: itself
/// alone. A part of a topic holds alternatives: a given one replaces all that a preset sets.
enum class Topic {
  own,
  focus,
  clip,
  boundary, ///< part of clip
  view,
  eye,    ///< part of view
  extent, ///< part of view
  materials,
  lights,
  stop,
  process ///< files, and how the program works: stored in no scene, for it shapes no picture
};

/// Topic that a part belongs to; else the topic itself.
constexpr Topic wholeOf(Topic topic) {
  using enum Topic;
  if (topic == boundary)
    return clip;
  return topic == eye || topic == extent ? view : topic;
}

/// Things without which a flag has no effect, and is refused: a focus, any clip, labels (of a
/// focus or of materials), or a kind of clip.
enum class Needs { nothing, focus, labels, clip, plane, hole, ghost, surface, spline };

struct Flag {
  std::string name;  ///< one lower-case word, without dashes
  std::string value; ///< placeholder in the help, such as FILE; empty: a switch
  std::string group; ///< heading in the help
  std::string text;  ///< one sentence of help; "[…]" at its end: a default in words
  Takes takes = {};
  Topic topic = Topic::own;
  Needs needs = Needs::nothing;

  bool isSwitch() const { return value.empty(); }
  /// True if the value names a file to be written.
  bool isWritten() const { return takes.channel == "output"; }
  /// True if the value may name a file.
  bool takesFile() const { return value.find("FILE") != std::string::npos; }
  /// Sentence of help with the default, "… [50]".
  std::string help() const;
};

struct Positional {
  std::string name;
  std::string text;                    ///< one sentence of help
  std::vector<std::string> words = {}; ///< values; empty: it names a file
  bool repeats = false;                ///< the last may be given several times
};

/// Flags of another command that this one shares its table with, but does not take.
struct Refusal {
  std::vector<std::string> names;
  std::string why; ///< and what to do; the rest of the message
};

struct CommandSyntax {
  std::string name;
  std::string summary;
  std::vector<Positional> positionals; ///< all required, in order
  std::span<const Flag> flags;         ///< those refused, too
  std::vector<Refusal> refusals = {};
};

/// Flag values as the user gave them. Accessors throw Error (usage) for values that the flag does
/// not take; those without "optional" are for flags that are given.
class FlagValues {
public:
  explicit FlagValues(std::span<const Flag> flags) : m_flags(flags) {}

  bool has(const std::string& name) const { return m_values.contains(name); }
  /// True if the flag was given with another value than its default.
  bool differs(const std::string& name) const;
  std::optional<std::string> text(const std::string& name) const;
  /// Finite number in the flag's range.
  std::optional<double> number(const std::string& name) const;
  /// The same; nothing for auto.
  std::optional<double> numberOrAuto(const std::string& name) const;
  /// True for a flag's value that changes nothing (Takes::idle).
  bool isIdle(const std::string& name) const;
  std::optional<std::uint64_t> count(const std::string& name) const;
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
  template <typename Place>
  void read(const std::string& name, Place& place) const {
    if constexpr (std::is_same_v<Place, std::vector<std::string>>)
      place = list(name);
    else if constexpr (std::is_same_v<Place, std::vector<std::filesystem::path>>)
      std::ranges::copy(texts(name), std::back_inserter(place));
    else if constexpr (std::is_integral_v<Place>)
      place = static_cast<Place>(*count(name));
    else if constexpr (std::is_assignable_v<Place&, Vec3>)
      place = triple(name);
    else if constexpr (std::is_assignable_v<Place&, std::string>)
      place = word(name);
    else
      place = *number(name);
  }

  /// All given values, "name: value" a line.
  std::string echo() const;
  /// All given values as arguments of a command line.
  std::vector<std::string> arguments() const;

  void add(const std::string& name, const std::string& value) { m_values[name].push_back(value); }
  void remove(const std::string& name) { m_values.erase(name); }

private:
  const Flag& flag(const std::string& name) const;

  std::span<const Flag> m_flags;
  std::map<std::string, std::vector<std::string>> m_values;
};

/// Flag with that name; null: none.
const Flag* findFlag(std::span<const Flag> flags, std::string_view name);

} // namespace fenestra
