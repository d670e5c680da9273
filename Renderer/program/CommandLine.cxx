#include "program/CommandLine.h"

#include "base/Error.h"
#include "program/Help.h"
#include "program/Version.h"

#include <algorithm>
#include <iostream>
#include <vector>

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

/// Error for a value that is missing or is the next flag, and for a switch with a value.
Error wrongValue(const Flag& flag) {
  if (isSwitch(flag))
    return usageError(std::string("--") + flag.name + ": is a switch; write it without a value");
  return usageError(std::string("--") + flag.name + ": its value is missing; write --" + flag.name +
                    " " + flag.value);
}

/// Parses words into values, by a command's syntax.
class Parser {
public:
  explicit Parser(const CommandSyntax& syntax) : m_syntax(syntax), m_values(syntax.flags) {}

  FlagValues parse(std::span<const std::string_view> words) {
    bool flagsEnded = false;
    for (m_words = words; !m_words.empty();) {
      const std::string_view word = taken();
      if (!flagsEnded && word == "--")
        flagsEnded = true;
      else if (!flagsEnded && word.size() > 1 && word[0] == '-')
        takeFlag(word);
      else
        takePositional(word);
    }
    if (m_positionals < m_syntax.positionals.size()) {
      const Positional& missing = m_syntax.positionals[m_positionals];
      throw usageError(std::string(missing.name) + ": is missing; name it: " + missing.text +
                       seeHelp(m_syntax));
    }
    return m_values;
  }

private:
  std::string_view taken() {
    const std::string_view word = m_words.front();
    m_words = m_words.subspan(1);
    return word;
  }

  void takeFlag(std::string_view word) {
    const std::size_t equals = word.find('=');
    const Flag* const flag =
        word.starts_with("--") ? findFlag(m_syntax.flags, word.substr(2, equals - 2)) : nullptr;
    if (!flag)
      throw unknownFlag(m_syntax, word);
    std::string_view value;
    if (equals != word.npos)
      value = word.substr(equals + 1);
    else if (!isSwitch(*flag) && !m_words.empty())
      value = checkedValue(*flag, taken());
    if (value.empty() != isSwitch(*flag) || (isSwitch(*flag) && equals != word.npos))
      throw wrongValue(*flag);
    m_values.add(flag->name, std::string(value));
  }

  /// Value that is a word of its own, after the flag.
  static std::string_view checkedValue(const Flag& flag, std::string_view word) {
    if (word.starts_with("--"))
      throw wrongValue(flag);
    if (word.empty())
      throw usageError(std::string("--") + flag.name + ": its value is empty; write --" +
                       flag.name + " " + flag.value);
    return word;
  }

  void takePositional(std::string_view word) {
    if (m_positionals == m_syntax.positionals.size())
      throw extraArgument(m_syntax, std::string(word));
    const char* const name = m_syntax.positionals[m_positionals++].name;
    if (word.empty())
      throw usageError(std::string(name) + ": is empty; name a file");
    m_values.add(name, std::string(word));
  }

  const CommandSyntax& m_syntax;
  FlagValues m_values;
  std::span<const std::string_view> m_words; ///< not parsed yet
  std::size_t m_positionals = 0;             ///< parsed so far
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
  constexpr std::size_t longest = 32; // no name is longer, but a path may be
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
  const std::vector<std::string_view> words(argv + first, argv + argc);
  const auto asksFor = [&words](std::string_view word) {
    return std::find(words.begin(), words.end(), word) != words.end();
  };
  if (asksFor("--help"))
    std::cout << helpText(syntax) << std::flush;
  else if (asksFor("--version"))
    std::cout << "fenestra " << versionText << std::endl;
  else
    return Parser(syntax).parse(words);
  return std::nullopt;
}

} // namespace fenestra
