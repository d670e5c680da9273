#pragma once
// Makes text from files safe for messages: one line of valid UTF-8; sanitize(): at most 80 bytes.

#include <algorithm>
#include <span>
#include <string>
#include <string_view>

namespace fenestra::core {

/// Size in bytes of the UTF-8 character at the start of `text`; 0: empty, or not valid UTF-8 (The
/// Unicode Standard 15.0, table 3-7).
inline std::size_t characterSize(std::string_view text) {
  const auto byte = [&text](std::size_t i) {
    return i < text.size() ? static_cast<unsigned char>(text[i]) : 0U;
  };
  const unsigned first = byte(0);
  if (first < 0x80)
    return text.empty() ? 0 : 1;
  const std::size_t size = first >= 0xf0 ? 4 : first >= 0xe0 ? 3 : 2;
  const unsigned low = first == 0xe0 ? 0xa0 : first == 0xf0 ? 0x90 : 0x80;
  const unsigned high = first == 0xed ? 0x9f : first == 0xf4 ? 0x8f : 0xbf;
  if (first < 0xc2 || first > 0xf4 || byte(1) < low || byte(1) > high)
    return 0;
  for (std::size_t i = 2; i < size; ++i)
    if ((byte(i) & 0xc0U) != 0x80U)
      return 0;
  return size;
}

/// Replaces control characters by blanks, and bytes that are not UTF-8 by question marks.
inline void makeOneLine(std::span<char> text) {
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t size = characterSize({text.data() + at, text.size() - at});
    const auto c = static_cast<unsigned char>(text[at]);
    if (size == 0)
      text[at] = '?';
    else if (c < 0x20 || c == 0x7f)
      text[at] = ' ';
    at += std::max<std::size_t>(size, 1);
  }
}
inline std::string toOneLine(std::string text) {
  makeOneLine(text);
  return text;
}

/// First 80 bytes at most, cut between characters, on one line.
inline std::string sanitize(const std::string& text) {
  std::size_t end = std::min<std::size_t>(text.size(), 80);
  for (int i = 0; i < 3 && end < text.size() && end > 0; ++i)
    if ((static_cast<unsigned char>(text[end]) & 0xc0U) == 0x80U)
      --end;
  return toOneLine(text.substr(0, end));
}

} // namespace fenestra::core
