#pragma once
// Text functions, independent of the locale. Whitespace is space, tab, carriage return and line
// feed.

#include <charconv>
#include <concepts>
#include <cstdint>
#include <functional>
#include <iterator>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace fenestra::core {

/// Concatenates texts and paths as they are, and integers in decimal.
template <typename... Parts>
std::string concat(const Parts&... parts) {
  std::string text;
  const auto append = [&text]<typename Part>(const Part& part) {
    static_assert(!std::floating_point<Part>, "use toString to choose the digits");
    if constexpr (std::integral<Part> && !std::same_as<Part, char>)
      text += std::to_string(part);
    else if constexpr (requires { part.string(); })
      text += part.string();
    else
      text += part;
  };
  (append(parts), ...);
  return text;
}

/// Number with at most `digits` significant digits, like printf's %.6g.
std::string toString(double x, int digits = 6);

/// Items as text, with `separator` between them; `rest` replaces those after the first `maxItems`.
template <typename Items, typename ToText = std::identity>
std::string join(const Items& items, std::string_view separator, ToText&& toText = {},
                 std::size_t maxItems = std::numeric_limits<std::size_t>::max(),
                 std::string_view rest = "…") {
  std::string text;
  std::size_t count = 0;
  for (const auto& item : items) {
    if (count > 0)
      text += separator;
    if (count++ == maxItems)
      return text.append(rest);
    text += toText(item);
  }
  return text;
}

/// Numbers with `separator` between them, each formatted by toString or concat.
template <typename Numbers>
std::string joinNumbers(const Numbers& numbers, std::string_view separator, int digits = 6) {
  return join(numbers, separator, [digits](auto x) {
    if constexpr (std::floating_point<decltype(x)>)
      return toString(x, digits);
    else
      return concat(x);
  });
}

/// Bytes of the numbers in memory.
template <typename Numbers>
std::string_view asBytes(const Numbers& numbers) {
  return {reinterpret_cast<const char*>(std::data(numbers)),
          std::size(numbers) * sizeof(*std::data(numbers))};
}

std::string toLower(std::string_view text);
std::string_view trim(std::string_view text, std::string_view whitespace = " \t\r\n");
/// Parts between whitespace.
std::vector<std::string> splitWords(std::string_view text);
/// Lower-case words in the first 1000 characters of a name. Words consist of letters, digits and
/// the characters of `extra`; a capital after a lower-case letter starts a new word. "Left lung",
/// "lung_left" and "LungLeft" have the same words.
std::vector<std::string> splitName(std::string_view name, std::string_view extra = "");
/// Parts between separators, as std::getline reads them: an empty last part is dropped.
std::vector<std::string> split(std::string_view text, char separator);
/// Wraps `text` into lines of at most `width` bytes; a longer word gets its own line.
std::string wrapLines(std::string_view text, std::size_t width);
/// Text with every `from` replaced by `to`.
std::string replaceAll(std::string_view text, std::string_view from, std::string_view to);

/// Candidate that `word` probably misspells or abbreviates; empty: none.
std::string findNearest(std::string_view word, std::span<const std::string> candidates);

/// The number that the complete text represents; nullopt: other text.
template <typename Number>
std::optional<Number> parseNumber(std::string_view text) {
  Number number{};
  const char* const end = text.data() + text.size();
  const auto [next, failure] = std::from_chars(text.data(), end, number);
  return failure == std::errc() && next == end ? std::optional(number) : std::nullopt;
}
inline std::optional<std::int64_t> parseInteger(std::string_view text) {
  return parseNumber<std::int64_t>(trim(text));
}
/// Finite numbers separated by whitespace, as Slicer writes them; nullopt: any other text.
std::optional<std::vector<double>> parseNumbers(std::string_view text);

} // namespace fenestra::core
