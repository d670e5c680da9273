#include "base/Text.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>

namespace fenestra::core {
namespace {

/// Optimal string alignment distance: insertions, deletions, substitutions, adjacent swaps.
std::size_t computeEditDistance(std::string_view a, std::string_view b) {
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

std::string toString(double x, int digits) {
  std::array<char, 64> text;
  const auto [end, failure] =
      std::to_chars(text.data(), text.data() + text.size(), x, std::chars_format::general, digits);
  return {text.data(), end};
}

std::string toLower(std::string_view text) {
  std::string result(text);
  std::transform(result.begin(), result.end(), result.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return result;
}

std::string_view trim(std::string_view text, std::string_view whitespace) {
  const std::size_t first = std::min(text.find_first_not_of(whitespace), text.size());
  return text.substr(first, text.find_last_not_of(whitespace) + 1 - first);
}

std::vector<std::string> splitWords(std::string_view text) {
  constexpr std::string_view whitespace = " \t\r\n";
  std::vector<std::string> found;
  for (text = trim(text); !text.empty(); text = trim(text)) {
    const std::size_t end = std::min(text.find_first_of(whitespace), text.size());
    found.emplace_back(text.substr(0, end));
    text.remove_prefix(end);
  }
  return found;
}

std::vector<std::string> splitName(std::string_view name, std::string_view extra) {
  constexpr std::size_t maxLength = 1000;
  const auto isUpper = [](char c) { return std::isupper(static_cast<unsigned char>(c)) != 0; };
  std::vector<std::string> found;
  char before = ' ';
  for (const char c : name.substr(0, maxLength)) {
    const bool inWord = std::isalnum(static_cast<unsigned char>(c)) != 0 || (c & 0x80) != 0 ||
                        extra.find(c) != std::string_view::npos;
    const bool begins = before == ' ' || (isUpper(c) && !isUpper(before));
    if (inWord && begins)
      found.emplace_back();
    if (inWord)
      found.back() += toLower({&c, 1});
    before = inWord ? c : ' ';
  }
  return found;
}

std::vector<std::string> split(std::string_view text, char separator) {
  std::vector<std::string> parts;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find(separator), text.size());
    parts.emplace_back(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return parts;
}

std::string wrapLines(std::string_view text, std::size_t width) {
  std::string lines;
  std::size_t used = 0;
  for (const std::string& word : split(text, ' ')) {
    const bool fits = used + 1 + word.size() <= width;
    if (!lines.empty())
      lines += fits ? ' ' : '\n';
    lines += word;
    used = (fits ? used + 1 : 0) + word.size();
  }
  return lines;
}

std::string replaceAll(std::string_view text, std::string_view from, std::string_view to) {
  std::string result;
  for (std::size_t at = text.find(from); at != std::string_view::npos; at = text.find(from)) {
    result.append(text.substr(0, at)).append(to);
    text.remove_prefix(at + from.size());
  }
  return result.append(text);
}

std::optional<std::vector<double>> parseNumbers(std::string_view text) {
  std::vector<double> numbers;
  const auto isBlank = [](unsigned char c) { return std::isspace(c); };
  for (const char *at = text.data(), *const end = at + text.size();;) {
    at = std::find_if_not(at, end, isBlank);
    if (at == end)
      return numbers;
    double& x = numbers.emplace_back();
    const auto [next, failure] = std::from_chars(at, end, x);
    if (failure != std::errc() || !std::isfinite(x))
      return std::nullopt;
    at = next;
  }
}

std::string findNearest(std::string_view word, std::span<const std::string> candidates) {
  constexpr std::size_t longest = 32; // names are shorter; a path may not be
  std::string best;
  std::size_t least =
      std::min<std::size_t>(3, word.size() / 3 + 1); // a likely misspelling has fewer edits
  if (word.empty() || word.size() > longest)
    return best;
  for (const std::string& candidate : candidates) {
    const bool isPrefix = word.size() >= 2 && candidate.starts_with(word);
    const std::size_t distance = isPrefix ? 1 : computeEditDistance(word, candidate);
    if (distance < least) {
      least = distance;
      best = candidate;
    }
  }
  return best;
}

} // namespace fenestra::core
