#pragma once
// Flags as data: one table describes them, and --help and parsing read it.

#include "core/Vector.h"

#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace fenestra {

struct Flag {
  const char* name;  ///< one lower-case word, without dashes
  const char* value; ///< what the value looks like; empty for a switch
  const char* group; ///< heading in the help
  const char* text;  ///< one sentence of help
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

/// Flag values as the user gave them; accessors convert, and throw Error (usage) that names the
/// flag.
class FlagValues {
public:
  bool has(const std::string& name) const { return m_values.contains(name); }
  std::optional<std::string> text(const std::string& name) const;
  std::vector<std::string> texts(const std::string& name) const;
  /// A finite number in [least, greatest].
  std::optional<double> number(const std::string& name, double least, double greatest) const;
  std::optional<std::uint64_t> count(const std::string& name, std::uint64_t least,
                                     std::uint64_t greatest) const;
  std::optional<Vec3> triple(const std::string& name) const;
  /// Exactly `size` finite numbers, separated by commas.
  std::optional<std::vector<double>> numbers(const std::string& name, std::size_t size) const;
  /// One of the words.
  std::optional<std::string> word(const std::string& name,
                                  const std::vector<std::string>& words) const;
  /// All values of a repeatable flag, split at commas; "\," is a comma.
  std::vector<std::string> list(const std::string& name) const;

  void add(const std::string& name, const std::string& value) { m_values[name].push_back(value); }

private:
  std::map<std::string, std::vector<std::string>> m_values;
};

} // namespace fenestra
