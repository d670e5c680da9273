#pragma once
// Text from files in messages: on one line, and short where it can be.

#include <algorithm>
#include <string>

namespace fenestra {

/// Control characters become blanks.
inline std::string oneLine(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return c < 0x20 || c == 0x7f; }, ' ');
  return text;
}

inline std::string shown(const std::string& text) {
  return oneLine(text.substr(0, 80));
}

} // namespace fenestra
