#pragma once
// Small tools on text, independent of the locale. Blanks are space, tab, carriage return and line
// feed.

#include <charconv>
#include <concepts>
#include <cstdint>
#include <functional>
#include <iterator>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace fenestra {

/// Parts one after the other: texts and paths as they are, whole numbers in decimal.
template <typename... Parts>
std::string concat(const Parts&... parts) {
  std::string text;
  const auto append = [&text]<typename Part>(const Part& part) {
    static_assert(!std::floating_point<Part>, "say how many digits: numberText");
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

/// Number in at most `digits` significant digits, like printf's %.6g.
std::string toString(double x, int digits = 6);

/// Texts of the items with `separator` between them; of more than `most` the first, then `rest`.
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

/// Numbers with `separator` between them, each as toString or textOf has it.
template <typename Numbers>
std::string joinNumbers(const Numbers& numbers, std::string_view separator, int digits = 6) {
  return join(numbers, separator, [digits](auto x) {
    if constexpr (std::floating_point<decltype(x)>)
      return toString(x, digits);
    else
      return concat(x);
  });
}

/// Numbers as they lie in memory.
template <typename Numbers>
std::string_view asBytes(const Numbers& numbers) {
  return {reinterpret_cast<const char*>(std::data(numbers)),
          std::size(numbers) * sizeof(*std::data(numbers))};
}

std::string toLower(std::string_view text);
std::string_view trim(std::string_view text, std::string_view whitespace = " \t\r\n");
/// Parts between blanks.
std::vector<std::string> splitWords(std::string_view text);
/// Words of a name in lower case, of its first 1000 characters: letters and digits, and what `kept`
/// lists; a capital after a small letter begins another. "Left lung", "lung_left" and "LungLeft"
/// have the same words.
std::vector<std::string> splitName(std::string_view name, std::string_view extra = "");
/// Parts between separators, as std::getline reads them: none is empty at the end.
std::vector<std::string> split(std::string_view text, char separator);
/// Words of `text` in lines of at most `width` bytes; a longer word has its own line.
std::string wrapLines(std::string_view text, std::size_t width);
/// Text with every `from` replaced by `to`.
std::string replaceAll(std::string_view text, std::string_view from, std::string_view to);

/// Number that is the whole text; nullopt: other text.
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
/// Finite numbers between white space, as Slicer writes them; nullopt: any other text.
std::optional<std::vector<double>> parseNumbers(std::string_view text);

} // namespace fenestra
