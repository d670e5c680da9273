#include "io/Base64.h"

#include <algorithm>
#include <cstdint>

namespace fenestra::core {
namespace {

constexpr std::string_view alphabet =
    "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

} // namespace

std::string toBase64(std::string_view bytes) {
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t at = 0; at < bytes.size(); at += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - at);
    std::uint32_t group = 0;
    for (std::size_t i = 0; i < 3; ++i)
      group = group << 8 | (i < count ? static_cast<unsigned char>(bytes[at + i]) : 0u);
    for (std::size_t i = 0; i < 4; ++i)
      text += i <= count ? alphabet[group >> (18 - 6 * i) & 0x3f] : '=';
  }
  return text;
}

std::optional<std::string> fromBase64(std::string_view text) {
  const std::size_t padding = text.ends_with("==") ? 2 : text.ends_with('=') ? 1 : 0;
  if (text.size() % 4 != 0 || text.find_first_not_of(alphabet) < text.size() - padding)
    return std::nullopt;
  std::string bytes;
  bytes.reserve(text.size() / 4 * 3);
  for (std::size_t at = 0; at < text.size(); at += 4) {
    std::uint32_t group = 0;
    for (const char c : text.substr(at, 4))
      group = group << 6 | static_cast<std::uint32_t>(c == '=' ? 0 : alphabet.find(c));
    for (const int shift : {16, 8, 0})
      bytes += static_cast<char>(group >> shift & 0xff);
  }
  bytes.erase(bytes.size() - padding);
  return bytes;
}

} // namespace fenestra::core
