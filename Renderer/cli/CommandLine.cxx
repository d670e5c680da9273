#include "cli/CommandLine.h"

#include "cli/Version.h"
#include "core/Error.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <iostream>
#include <map>

namespace fenestra {
namespace {

std::string seeHelp(const CommandSyntax& syntax) {
  return std::string(" (fenestra ") + syntax.name + " --help lists what there is)";
}

Error unknownFlag(const CommandSyntax& syntax, std::string_view given) {
  given = given.substr(0, given.find('='));
  std::vector<std::string_view> names = {"help", "version"};
  for (const Flag& flag : syntax.flags)
    names.push_back(flag.name);
  std::string word(given.substr(std::min(given.find_first_not_of('-'), given.size())));
  std::transform(word.begin(), word.end(), word.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  const std::string_view likely = nearest(word, names);
  const std::string mend = likely.empty() ? "" : "; did you mean --" + std::string(likely) + "?";
  return usageError(std::string(given) + ": no such flag" + mend + seeHelp(syntax));
}

Error extraArgument(const CommandSyntax& syntax, const std::string& given) {
  std::string expected;
  for (const Positional& positional : syntax.positionals)
    expected += (expected.empty() ? "" : " and ") + std::string(positional.name);
  return usageError("'" + given + "': one argument too many after " + expected +
                    "; quote names with blanks" + seeHelp(syntax));
}

bool isSwitch(const Flag& flag) {
  return *flag.value == 0;
}

/// A value that is missing, or that is the next flag; or one that a switch has.
Error wrongValue(const Flag& flag) {
  if (isSwitch(flag))
    return usageError(std::string("--") + flag.name + ": is a switch; write it without a value");
  return usageError(std::string("--") + flag.name + ": its value is missing; write --" + flag.name +
                    " " + flag.value);
}

/// What CLI11 says of a flag's value, in our words; its messages start with the flag, some of them
/// without its dashes.
Error valueError(const CommandSyntax& syntax, const CLI::Error& error) {
  const std::string message = error.what();
  const std::size_t dashes = message.find("--");
  const std::size_t begin = dashes == std::string::npos ? 0 : dashes + 2;
  const std::size_t end = message.find_first_of(": ,", begin);
  if (const Flag* flag =
          findFlag(syntax.flags, std::string_view(message).substr(begin, end - begin)))
    return wrongValue(*flag);
  return usageError(message.substr(0, message.find('\n')) + seeHelp(syntax));
}

/// A command's syntax, declared to CLI11, and where it puts what it finds.
class Parser {
public:
  explicit Parser(const CommandSyntax& syntax)
      : m_syntax(syntax),
        m_app(wrapped(syntax.summary, page), std::string("fenestra ") + syntax.name) {
    m_app.set_help_flag("--help", "Print this and exit");
    m_app.set_version_flag("--version", std::string("fenestra ") + versionText);
    m_app.get_formatter()->column_width(column);
    m_app.allow_extras(); // so that we can say what was meant
    for (const Positional& positional : syntax.positionals)
      m_app
          .add_option(positional.name, m_positionals[positional.name],
                      wrapped(positional.text, page - column))
          ->type_name("");
    for (const Flag& flag : syntax.flags)
      isSwitch(flag) ? addSwitch(flag) : addFlag(flag);
  }

  /// Nothing where help or version was asked for, and printed.
  std::optional<FlagValues> parse(std::vector<std::string> arguments) {
    std::reverse(arguments.begin(), arguments.end()); // as CLI11 wants them
    try {
      m_app.parse(arguments);
    } catch (const CLI::Success& success) {
      m_app.exit(success, std::cout, std::cerr);
      return std::nullopt;
    } catch (const CLI::Error& error) {
      throw valueError(m_syntax, error);
    }
    refuseMissingValues(); // before the words that they have made extra
    refuseExtras();
    return values();
  }

private:
  void addFlag(const Flag& flag) {
    m_app
        .add_option(std::string("--") + flag.name, m_flags[flag.name],
                    wrapped(flag.text, page - column))
        ->type_name(flag.value)
        ->group(flag.group)
        ->expected(1)
        ->allow_extra_args(false)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  }

  void addSwitch(const Flag& flag) {
    m_app
        .add_flag(std::string("--") + flag.name, m_switches[flag.name],
                  wrapped(flag.text, page - column))
        ->group(flag.group)
        ->disable_flag_override();
  }

  /// A flag in the place of another one's value.
  void refuseMissingValues() const {
    for (const Flag& flag : m_syntax.flags)
      if (const auto given = m_flags.find(flag.name); given != m_flags.end())
        for (const std::string& value : given->second)
          if (value.starts_with("--"))
            throw wrongValue(flag);
  }

  void refuseExtras() const {
    for (const std::string& extra : m_app.remaining())
      throw extra.size() > 1 && extra[0] == '-'
          ? unknownFlag(m_syntax, extra.substr(0, extra.find('=')))
          : extraArgument(m_syntax, extra);
  }

  FlagValues values() const {
    FlagValues values(m_syntax.flags);
    for (const Positional& positional : m_syntax.positionals) {
      const std::string& found = m_positionals.at(positional.name);
      if (m_app.count(positional.name) == 0)
        throw usageError(std::string(positional.name) +
                         ": is missing; name it: " + positional.text + seeHelp(m_syntax));
      if (found.empty())
        throw usageError(std::string(positional.name) + ": is empty; name a file");
      values.add(positional.name, found);
    }
    for (const Flag& flag : m_syntax.flags)
      if (!isSwitch(flag))
        addValues(flag, values);
      else if (m_switches.at(flag.name))
        values.add(flag.name, "");
    return values;
  }

  void addValues(const Flag& flag, FlagValues& values) const {
    for (const std::string& value : m_flags.at(flag.name)) {
      if (value.empty())
        throw usageError(std::string("--") + flag.name + ": its value is empty; write --" +
                         flag.name + " " + flag.value);
      values.add(flag.name, value);
    }
  }

  static constexpr std::size_t page = 80, column = 30; ///< of the help

  const CommandSyntax& m_syntax;
  CLI::App m_app;
  std::map<std::string, std::string> m_positionals;
  std::map<std::string, std::vector<std::string>> m_flags;
  std::map<std::string, bool> m_switches;
};

/// Optimal string alignment distance: insertions, deletions, substitutions and swapped neighbours.
std::size_t editDistance(std::string_view a, std::string_view b) {
  std::vector<std::vector<std::size_t>> d(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i)
    for (std::size_t j = 0; j <= b.size(); ++j) {
      if (i == 0 || j == 0) {
        d[i][j] = i + j;
        continue;
      }
      d[i][j] = std::min(
          {d[i - 1][j] + 1, d[i][j - 1] + 1, d[i - 1][j - 1] + (a[i - 1] == b[j - 1] ? 0u : 1u)});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
    }
  return d[a.size()][b.size()];
}

} // namespace

std::string wrapped(std::string_view text, std::size_t width) {
  std::string lines;
  std::size_t used = 0;
  while (!text.empty()) {
    const std::string_view word = text.substr(0, text.find(' '));
    text.remove_prefix(std::min(word.size() + 1, text.size()));
    const bool fits = used + 1 + word.size() <= width;
    if (!lines.empty())
      lines += fits ? ' ' : '\n';
    lines += word;
    used = (fits ? used + 1 : 0) + word.size();
  }
  return lines;
}

std::string_view nearest(std::string_view word, std::span<const std::string_view> candidates) {
  constexpr std::size_t longest = 32; // no name is longer, and a path may be
  std::string_view best;
  std::size_t least = std::min<std::size_t>(3, word.size() / 3 + 1); // more is no misspelling
  if (word.empty() || word.size() > longest)
    return best;
  for (const std::string_view candidate : candidates) {
    const bool cut = word.size() >= 2 && candidate.starts_with(word);
    const std::size_t distance = cut ? 1 : editDistance(word, candidate);
    if (distance < least) {
      least = distance;
      best = candidate;
    }
  }
  return best;
}

std::optional<FlagValues> parseCommandLine(const CommandSyntax& syntax, int argc, char** argv,
                                           int first) {
  return Parser(syntax).parse({argv + first, argv + argc});
}

} // namespace fenestra
