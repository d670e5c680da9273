#pragma once
// Switch of the planted errors (README.md here).

#include <cstdint>
#include <string_view>
#include <type_traits>

namespace fenestra::testing {

/// Key of a name (FNV-1a), compared faster than its text.
constexpr std::uint32_t faultKey(std::string_view name) {
  std::uint32_t key = 2166136261U;
  for (const char c : name)
    key = (key ^ static_cast<std::uint32_t>(c)) * 16777619U;
  return key;
}

/// Key of the active error; 0: none.
inline std::uint32_t plantedFault = 0;

} // namespace fenestra::testing

#define PLANTED(name)                                                                              \
  (::fenestra::testing::plantedFault ==                                                            \
   std::integral_constant<std::uint32_t, ::fenestra::testing::faultKey(#name)>::value)
