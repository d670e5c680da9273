#pragma once
// Numbers separated by blanks, as Slicer writes them in attributes and text files.

#include <cctype>
#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>
#include <vector>

namespace fenestra {

/// Parses all numbers, independent of the locale. nullopt: other text, or a number that is not
/// finite.
inline std::optional<std::vector<double>> parseNumbers(std::string_view text) {
  std::vector<double> numbers;
  const char* at = text.data();
  const char* const end = at + text.size();
  const auto skipBlanks = [&] {
    while (at != end && std::isspace(static_cast<unsigned char>(*at)))
      ++at;
  };
  for (skipBlanks(); at != end; skipBlanks()) {
    double x = 0.0;
    const auto [next, failure] = std::from_chars(at, end, x);
    if (failure != std::errc() || !std::isfinite(x))
      return std::nullopt;
    numbers.push_back(x);
    at = next;
  }
  return numbers;
}

} // namespace fenestra
