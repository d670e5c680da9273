#pragma once
// Text from files in messages: on one line, and short.

#include <algorithm>
#include <string>

namespace fenestra {

inline std::string shown(const std::string& text) {
  std::string line = text.substr(0, 80);
  std::replace_if(
      line.begin(), line.end(), [](unsigned char c) { return c < 0x20 || c == 0x7f; }, ' ');
  return line;
}

} // namespace fenestra
