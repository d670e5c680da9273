#pragma once
// Flags as data: one table describes them, and --help, parsing and Slicer's description read it.

#include "base/Vector.h"

#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace fenestra {

/// What a flag's value may be. Parsing refuses the rest, and Slicer's panel offers no more.
struct Takes {
  enum class Kind {
    text,    ///< anything; what it means is decided elsewhere
    list,    ///< texts separated by commas
    numbers, ///< separated by commas
    number,
    whole,
    word,      ///< one of few
    labels,    ///< a segmentation, which is read
    picture,   ///< a picture, which is written
    surface,   ///< a mesh, which is written
    report,    ///< a text file, which is written
    slicersOwn ///< a flag that every program of Slicer's has and none describes
  };
  Kind kind = Kind::text;
  double least = -infinity, greatest = infinity; ///< of numbers
  const char* words = "";                        ///< separated by bars

  static constexpr Takes list() { return {Kind::list}; }
  static constexpr Takes numbers() { return {Kind::numbers}; }
  static constexpr Takes labels() { return {Kind::labels}; }
  static constexpr Takes picture() { return {Kind::picture}; }
  static constexpr Takes surface() { return {Kind::surface}; }
  static constexpr Takes report() { return {Kind::report}; }
  static constexpr Takes slicersOwn() { return {Kind::slicersOwn}; }
  static constexpr Takes number(double least, double greatest) {
    return {Kind::number, least, greatest};
  }
  static constexpr Takes whole(double least, double greatest) {
    return {Kind::whole, least, greatest};
  }
  static constexpr Takes word(const char* words) {
    return {Kind::word, -infinity, infinity, words};
  }
};

struct Flag {
  const char* name;  ///< one lower-case word, without dashes
  const char* value; ///< what the value looks like; empty for a switch
  const char* group; ///< heading in the help
  const char* text;  ///< one sentence of help
  Takes takes = {};
  /// What Slicer's panel starts with: what leaving the flag out means, too, but for layers, since
  /// Slicer takes one file. Empty where no value means that.
  const char* standard = "";
};

struct Positional {
  const char* name;
  const char* text; ///< one sentence of help
};

/// What a command takes: positional arguments first, by name, then flags.
struct CommandSyntax {
  const char* name;
  const char* summary;
  std::vector<Positional> positionals; ///< all required, in order
  std::span<const Flag> flags;
};

/// Flag values as the user gave them; accessors convert by the table's rule, and throw Error
/// (usage) that names the flag.
class FlagValues {
public:
  explicit FlagValues(std::span<const Flag> flags) : m_flags(flags) {}

  bool has(const std::string& name) const { return m_values.contains(name); }
  /// Given, and not its standard value.
  bool differs(const std::string& name) const;
  std::optional<std::string> text(const std::string& name) const;
  std::vector<std::string> texts(const std::string& name) const;
  /// A finite number in the flag's range.
  std::optional<double> number(const std::string& name) const;
  std::optional<std::uint64_t> count(const std::string& name) const;
  std::optional<Vec3> triple(const std::string& name) const;
  /// Exactly `size` finite numbers, separated by commas.
  std::optional<std::vector<double>> numbers(const std::string& name, std::size_t size) const;
  /// One of the flag's words.
  std::optional<std::string> word(const std::string& name) const;
  /// All values of a repeatable flag, split at commas; "\," is a comma.
  std::vector<std::string> list(const std::string& name) const;

  /// All that was given, "name: value" a line.
  std::string echo() const;
  /// All that was given, as arguments that give it again.
  std::vector<std::string> arguments() const;

  void add(const std::string& name, const std::string& value) { m_values[name].push_back(value); }
  void remove(const std::string& name) { m_values.erase(name); }

private:
  const Flag& flag(const std::string& name) const;

  std::span<const Flag> m_flags;
  std::map<std::string, std::vector<std::string>> m_values;
};

/// The flag of that name; null where there is none.
const Flag* findFlag(std::span<const Flag> flags, std::string_view name);

/// True if its value names a file that is written: a picture, a surface or a report.
bool isWritten(const Flag& flag);

/// Six digits at most.
std::string shortNumber(double x);

/// The parts of a text between separators; at least one.
std::vector<std::string> splitAt(std::string_view text, char separator);

} // namespace fenestra
