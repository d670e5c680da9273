#pragma once
// Looks by name, or by what they are.

#include <string_view>

namespace fenestra {

/// Whether what names lights or a transfer function is no name but their JSON itself.
inline bool isLookText(std::string_view look) {
  return look.starts_with('{');
}

} // namespace fenestra
