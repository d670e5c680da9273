#include "files/looks/HexColor.h"

#include "base/safe/JsonNode.h"
#include "model/medium/VolumeProperty.h"

namespace fenestra {

Rgb readHexColor(const JsonNode& node) {
  const std::string text = node.text();
  if (text.size() != 7 || text[0] != '#' ||
      text.find_first_not_of("0123456789abcdefABCDEF", 1) != std::string::npos)
    throw node.error("must be a colour such as \"#d8a090\"");
  Rgb coded;
  for (int c = 0; c < 3; ++c)
    coded[c] = std::stoi(text.substr(static_cast<std::size_t>(1 + 2 * c), 2), nullptr, 16) / 255.0;
  return decodeSrgb(coded);
}

} // namespace fenestra
