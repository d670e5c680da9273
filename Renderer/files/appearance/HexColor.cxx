#include "files/appearance/HexColor.h"

#include "base/Color.h"

#include <string>

namespace fenestra::core {

Rgb readHexColor(const JsonNode& node) {
  const std::string text = node.value().is_string() ? node.text() : "";
  const bool isColor = text.size() == 7 && text[0] == '#' &&
                       text.find_first_not_of("0123456789abcdefABCDEF", 1) == std::string::npos;
  if (!isColor)
    throw node.error("must be a color such as \"#d8a090\"");
  Rgb encoded;
  for (int channel = 0; channel < 3; ++channel) {
    const std::size_t digit = 1 + 2 * static_cast<std::size_t>(channel);
    encoded[channel] = std::stoi(text.substr(digit, 2), nullptr, 16) / 255.0;
  }
  return decodeSrgb(encoded);
}

} // namespace fenestra::core
