#include "cli/CommandLine.h"

#include "cli/Version.h"
#include "core/Error.h"

#include <algorithm>
#include <iostream>

namespace fenestra {
namespace {

std::string seeHelp(const CommandSyntax& syntax) {
  return std::string(" (fenestra ") + syntax.name + " --help lists what there is)";
}

const Flag* find(const CommandSyntax& syntax, std::string_view name) {
  const auto it = std::find_if(syntax.flags.begin(), syntax.flags.end(),
                               [name](const Flag& flag) { return flag.name == name; });
  return it == syntax.flags.end() ? nullptr : &*it;
}

Error unknownFlag(const CommandSyntax& syntax, std::string_view given) {
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

/// -1,2,3 and -.5 are values, -x is a misspelt flag.
bool looksLikeFlag(std::string_view argument) {
  return argument.size() > 1 && argument[0] == '-' &&
         (argument[1] == '-' || std::isalpha(static_cast<unsigned char>(argument[1])));
}

class Parser {
public:
  Parser(const CommandSyntax& syntax, std::vector<std::string> arguments)
      : m_syntax(syntax), m_arguments(std::move(arguments)) {}

  FlagValues parse() {
    bool onlyPositionals = false;
    while (m_next < m_arguments.size()) {
      const std::string argument = m_arguments[m_next++];
      if (!onlyPositionals && argument == "--")
        onlyPositionals = true;
      else if (!onlyPositionals && looksLikeFlag(argument))
        takeFlag(argument);
      else
        takePositional(argument);
    }
    if (m_positionals < m_syntax.positionals.size()) {
      const Positional& missing = m_syntax.positionals[m_positionals];
      throw usageError(std::string(missing.name) + ": is missing; it is: " + missing.text +
                       seeHelp(m_syntax));
    }
    return std::move(m_values);
  }

private:
  void takeFlag(const std::string& argument) {
    const std::size_t equals = argument.find('=');
    const std::string dashed = argument.substr(0, equals);
    const Flag* flag = dashed.starts_with("--") ? find(m_syntax, dashed.substr(2)) : nullptr;
    if (!flag)
      throw unknownFlag(m_syntax, dashed);
    if (!*flag->value) {
      if (equals != std::string::npos)
        throw usageError(dashed + ": takes no value");
      return m_values.add(flag->name, "");
    }
    if (equals == std::string::npos &&
        (m_next == m_arguments.size() || m_arguments[m_next].starts_with("--")))
      throw usageError(dashed + ": its value is missing; write " + dashed + " " + flag->value);
    const std::string value =
        equals == std::string::npos ? m_arguments[m_next++] : argument.substr(equals + 1);
    if (value.empty())
      throw usageError(dashed + ": its value is empty; write " + dashed + " " + flag->value);
    m_values.add(flag->name, value);
  }

  void takePositional(const std::string& argument) {
    if (m_positionals == m_syntax.positionals.size())
      throw extraArgument(m_syntax, argument);
    const std::string name = m_syntax.positionals[m_positionals++].name;
    if (argument.empty())
      throw usageError(name + ": is empty; name a file");
    m_values.add(name, argument);
  }

  const CommandSyntax& m_syntax;
  std::vector<std::string> m_arguments;
  FlagValues m_values;
  std::size_t m_next = 0, m_positionals = 0;
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
  const std::vector<std::string> arguments(argv + first, argv + argc);
  const auto asked = [&](const char* flag) {
    return std::find(arguments.begin(), arguments.end(), flag) != arguments.end();
  };
  if (asked("--help")) {
    std::cout << helpText(syntax) << std::flush;
    return std::nullopt;
  }
  if (asked("--version")) {
    std::cout << "fenestra " << versionText << std::endl;
    return std::nullopt;
  }
  return Parser(syntax, arguments).parse();
}

} // namespace fenestra
