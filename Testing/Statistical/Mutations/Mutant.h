#pragma once
// Switch of the mutations (ApplyMutations.cmake).

#include <cstdint>
#include <string_view>
#include <type_traits>

namespace fenestra::core::testing {

/// Hash of a name (FNV-1a), which compares faster than its text.
constexpr std::uint32_t mutationKey(std::string_view name) {
  std::uint32_t key = 2166136261U;
  for (const char c : name)
    key = (key ^ static_cast<std::uint32_t>(c)) * 16777619U;
  return key;
}

/// Key of the active mutation; 0: none.
inline std::uint32_t activeMutation = 0;

} // namespace fenestra::core::testing

#define MUTANT(name)                                                                               \
  (::fenestra::core::testing::activeMutation ==                                                    \
   std::integral_constant<std::uint32_t, ::fenestra::core::testing::mutationKey(#name)>::value)
