#pragma once
// Flags as data: one table, read by --help, by parsing and by Slicer's description.

#include "base/Vector.h"

#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace fenestra {

/// Values that a flag accepts. Parsing refuses all others, and Slicer's panel offers no others.
struct Takes {
  enum class Kind {
    text,    ///< any text; checked by the code that uses the flag
    list,    ///< texts separated by commas
    numbers, ///< numbers separated by commas
    number,
    whole,
    word,      ///< one of `words`
    labels,    ///< segmentation file, read
    picture,   ///< picture file, written
    surface,   ///< mesh file, written
    report,    ///< text file, written
    slicersOwn ///< flag of all of Slicer's programs, described by none
  };
  Kind kind = Kind::text;
  double least = -infinity, greatest = infinity; ///< range of each number
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
  const char* value; ///< placeholder in the help, such as FILE; empty: a switch
  const char* group; ///< heading in the help
  const char* text;  ///< one sentence of help
  Takes takes = {};
  /// Default value, shown in Slicer's panel. Empty: no default. (Exception: `layers`; the panel
  /// starts with "color", since Slicer takes one file.)
  const char* standard = "";
};

struct Positional {
  const char* name;
  const char* text; ///< one sentence of help
};

/// Syntax of a command: positional arguments first, by name, then flags.
struct CommandSyntax {
  const char* name;
  const char* summary;
  std::vector<Positional> positionals; ///< all required, in order
  std::span<const Flag> flags;
};

/// Flag values as the user gave them. Accessors convert by the flag's `takes`, and throw Error
/// (usage) that names the flag.
class FlagValues {
public:
  explicit FlagValues(std::span<const Flag> flags) : m_flags(flags) {}

  bool has(const std::string& name) const { return m_values.contains(name); }
  /// True if the flag was given with another value than its default.
  bool differs(const std::string& name) const;
  std::optional<std::string> text(const std::string& name) const;
  std::vector<std::string> texts(const std::string& name) const;
  /// Finite number in the flag's range.
  std::optional<double> number(const std::string& name) const;
  std::optional<std::uint64_t> count(const std::string& name) const;
  std::optional<Vec3> triple(const std::string& name) const;
  /// Exactly `size` finite numbers, separated by commas.
  std::optional<std::vector<double>> numbers(const std::string& name, std::size_t size) const;
  /// One of the flag's words.
  std::optional<std::string> word(const std::string& name) const;
  /// All values of a repeatable flag, split at commas; "\," is a comma.
  std::vector<std::string> list(const std::string& name) const;

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

/// True if the value names a file to be written: picture, surface or report.
bool isWritten(const Flag& flag);

/// Decimal text with at most six digits.
std::string shortNumber(double x);

/// Parts of `text` between separators; at least one.
std::vector<std::string> splitAt(std::string_view text, char separator);

} // namespace fenestra
