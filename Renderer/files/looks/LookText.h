#pragma once
// Looks given by name, or as JSON text.

#include <string_view>

namespace fenestra {

/// True if `look` (lights or a transfer function) is JSON itself, not a name.
inline bool isLookText(std::string_view look) {
  return look.starts_with('{');
}

} // namespace fenestra
