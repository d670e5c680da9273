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
std::string textOf(const Parts&... parts) {
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
std::string numberText(double x, int digits = 6);

/// Texts of the items with `separator` between them; of more than `most` the first, then `rest`.
template <typename Items, typename TextOf = std::identity>
std::string joined(const Items& items, std::string_view separator, TextOf&& itemText = {},
                   std::size_t most = std::numeric_limits<std::size_t>::max(),
                   std::string_view rest = "…") {
  std::string text;
  std::size_t count = 0;
  for (const auto& item : items) {
    if (count > 0)
      text += separator;
    if (count++ == most)
      return text.append(rest);
    text += itemText(item);
  }
  return text;
}

/// Numbers with `separator` between them, each as numberText or textOf has it.
template <typename Numbers>
std::string numbersText(const Numbers& numbers, std::string_view separator, int digits = 6) {
  return joined(numbers, separator, [digits](auto x) {
    if constexpr (std::floating_point<decltype(x)>)
      return numberText(x, digits);
    else
      return textOf(x);
  });
}

/// Numbers as they lie in memory.
template <typename Numbers>
std::string_view memoryOf(const Numbers& numbers) {
  return {reinterpret_cast<const char*>(std::data(numbers)),
          std::size(numbers) * sizeof(*std::data(numbers))};
}

std::string lower(std::string_view text);
std::string_view trimmed(std::string_view text, std::string_view blanks = " \t\r\n");
/// Parts between blanks.
std::vector<std::string> words(std::string_view text);
/// Words of a name in lower case, of its first 1000 characters: letters and digits, and what `kept`
/// lists; a capital after a small letter begins another. "Left lung", "lung_left" and "LungLeft"
/// have the same words.
std::vector<std::string> nameWords(std::string_view name, std::string_view kept = "");
/// Parts between separators, as std::getline reads them: none is empty at the end.
std::vector<std::string> split(std::string_view text, char separator);
/// Words of `text` in lines of at most `width` bytes; a longer word has its own line.
std::string wrapped(std::string_view text, std::size_t width);
/// Text with every `from` replaced by `to`.
std::string replacedAll(std::string_view text, std::string_view from, std::string_view to);

/// Number that is the whole text; nullopt: other text.
template <typename Number>
std::optional<Number> parsed(std::string_view text) {
  Number number{};
  const char* const end = text.data() + text.size();
  const auto [next, failure] = std::from_chars(text.data(), end, number);
  return failure == std::errc() && next == end ? std::optional(number) : std::nullopt;
}
inline std::optional<std::int64_t> wholeNumber(std::string_view text) {
  return parsed<std::int64_t>(trimmed(text));
}
/// Finite numbers between white space, as Slicer writes them; nullopt: any other text.
std::optional<std::vector<double>> parseNumbers(std::string_view text);

} // namespace fenestra
