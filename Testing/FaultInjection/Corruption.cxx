#include "Corruption.h"

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <string_view>
#include <vector>

namespace fenestra::core::faults {
namespace {

/// Part of the bytes.
struct Span {
  std::size_t begin = 0, length = 0;

  std::size_t end() const { return begin + length; }
};

using Spans = std::vector<Span>;

std::size_t randomBelow(std::mt19937_64& random, std::size_t limit) {
  return limit == 0 ? 0 : random() % limit; // the same on every machine, unlike std distributions
}

template <typename Container>
const auto& randomElement(const Container& container, std::mt19937_64& random) {
  return container[randomBelow(random, std::size(container))];
}

constexpr std::string_view extremes[] = {
    "0",
    "-1",
    "1",
    "-0",
    "nan",
    "inf",
    "-inf",
    "",
    "1e308",
    "-1e308",
    "1e-308",
    "1e60",
    "1e300",
    "1e15",
    "1e-15",
    "0.5",
    "2147483647",
    "2147483648",
    "-2147483649",
    "65536",
    "99999",
    "1e1000",
    "0x10",
    "4294967296",
    "3000000",
    "256",
    "1000000000",
    "7",
    "2",
    "1,5",
    "1e-9",
    "1e9",
    "9223372036854775807",
    "18446744073709551616",
};

/// Leading text, before binary samples or tables.
std::string_view findText(std::string_view bytes) {
  return bytes.substr(0, bytes.find('\0'));
}

Spans findNumbers(std::string_view bytes) {
  Spans found;
  const auto isPart = [](char c) {
    return std::isdigit(static_cast<unsigned char>(c)) || c == '.' || c == '-' || c == 'e';
  };
  for (std::size_t at = 0; at < bytes.size();) {
    std::size_t end = at;
    while (end < bytes.size() && isPart(bytes[end]))
      ++end;
    if (end > at && std::any_of(bytes.begin() + static_cast<std::ptrdiff_t>(at),
                                bytes.begin() + static_cast<std::ptrdiff_t>(end),
                                [](unsigned char c) { return std::isdigit(c) != 0; }))
      found.push_back({at, end - at});
    at = end + 1;
  }
  return found;
}

/// Spans of name="value", including the space before them.
Spans findAttributes(std::string_view bytes) {
  Spans found;
  for (std::size_t at = 0; (at = bytes.find("=\"", at)) != bytes.npos;) {
    const std::size_t space = bytes.rfind(' ', at);
    const std::size_t end = bytes.find('"', at + 2);
    if (space == bytes.npos || end == bytes.npos)
      break;
    found.push_back({space, end + 1 - space});
    at = end;
  }
  return found;
}

Spans findLines(std::string_view bytes) {
  Spans found;
  for (std::size_t at = 0; at < bytes.size();) {
    const std::size_t end = std::min(bytes.find('\n', at), bytes.size() - 1) + 1;
    found.push_back({at, end - at});
    at = end;
  }
  return found;
}

Span randomBlock(std::string_view bytes, std::mt19937_64& random) {
  const std::size_t begin = randomBelow(random, bytes.size());
  const std::size_t maxLength =
      std::min<std::size_t>(bytes.size() - begin, std::size_t{1} << randomBelow(random, 13));
  return {begin, 1 + randomBelow(random, maxLength)};
}

/// Removes or repeats a part, copies it to the start of the other, or replaces it by the other.
void change(std::string& bytes, Span part, Span other, std::mt19937_64& random) {
  const std::string text = bytes.substr(part.begin, part.length);
  switch (randomBelow(random, 5)) {
  case 0:
    bytes.erase(part.begin, part.length);
    break;
  case 1:
    bytes.insert(part.begin, text);
    break;
  case 2:
    bytes.insert(other.begin, text);
    break;
  case 3:
    for (std::size_t count = std::size_t{1} << randomBelow(random, 9); count > 0; --count)
      bytes.insert(part.begin, text);
    break;
  default:
    bytes.replace(part.begin, part.length, bytes.substr(other.begin, other.length));
  }
}

void changeOneOf(std::string& bytes, const Spans& parts, std::mt19937_64& random) {
  if (!parts.empty()) {
    const Span part = randomElement(parts, random);
    change(bytes, part, randomElement(parts, random), random);
  }
}

void changeNumber(std::string& bytes, std::mt19937_64& random) {
  const Spans numbers = findNumbers(findText(bytes));
  if (numbers.empty())
    return;
  const Span number = randomElement(numbers, random);
  bytes.replace(number.begin, number.length, randomElement(extremes, random));
}

/// Repeats one byte many times, since long names and values can overflow buffers.
void lengthen(std::string& bytes, std::mt19937_64& random) {
  const std::size_t at = randomBelow(random, bytes.size());
  bytes.insert(at, std::string(std::size_t{1} << randomBelow(random, 18), bytes[at]));
}

void changeBytes(std::string& bytes, std::mt19937_64& random) {
  constexpr std::uint32_t words[] = {0,      1,          0x7f,       0xff,      0x7fff,
                                     0xffff, 0x7fffffff, 0x80000000, 0xffffffff};
  const std::uint32_t word =
      random() % 2 ? randomElement(words, random) : static_cast<std::uint32_t>(random());
  const std::size_t at = randomBelow(random, bytes.size());
  const std::size_t length =
      std::min<std::size_t>(std::size_t{1} << randomBelow(random, 3), bytes.size() - at);
  for (std::size_t i = 0; i < length; ++i)
    bytes[at + i] = static_cast<char>(word >> (8 * i));
}

void corruptOnce(std::string& bytes, std::mt19937_64& random) {
  if (bytes.empty())
    return;
  const std::string_view text = findText(bytes);
  switch (randomBelow(random, 10)) {
  case 0:
  case 1:
  case 2:
    return changeNumber(bytes, random);
  case 3:
  case 4:
    return changeOneOf(bytes, findAttributes(text), random);
  case 5:
    return changeOneOf(bytes, findLines(text), random);
  case 6:
    return change(bytes, randomBlock(bytes, random), randomBlock(bytes, random), random);
  case 7:
    return lengthen(bytes, random);
  case 8:
    return bytes.resize(randomBelow(random, bytes.size()));
  default:
    return changeBytes(bytes, random);
  }
}

} // namespace

std::string corrupt(std::string bytes, std::mt19937_64& random) {
  const std::string before = bytes;
  for (std::size_t count = 1 + randomBelow(random, 3); count > 0 || bytes == before;
       count -= count > 0)
    corruptOnce(bytes, random);
  return bytes;
}

} // namespace fenestra::core::faults
