#pragma once
// Bytes as text (RFC 4648, section 4), as in VTK's files.

#include <optional>
#include <string>
#include <string_view>

namespace fenestra::core {

std::string toBase64(std::string_view bytes);

/// Decodes groups of four digits, the last of which may end in "="; nullopt: any other text.
std::optional<std::string> fromBase64(std::string_view text);

} // namespace fenestra::core
