#pragma once
// Environment variables of a test run:
//   FENESTRA_LONG          set: run the long version
//   FENESTRA_BRIEF         how many times slower the build is: divides sample counts, multiplies
//                          time limits
//   FENESTRA_SEED          number that selects other seeds
//   FENESTRA_COMBINATIONS  number of combinations to test of the matrix, for slow builds
//   FENESTRA_MUTATIONS     comma-separated names of the mutations to test
//   FENESTRA_MUTATION_LIST another path of mutations.json

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <string>

namespace fenestra::core::testing {

inline bool isLongRun() {
  static const bool isLong = std::getenv("FENESTRA_LONG") != nullptr;
  return isLong;
}

inline std::optional<std::uint64_t> readEnvironmentNumber(const char* name) {
  const char* text = std::getenv(name);
  return text ? std::optional<std::uint64_t>(std::stoull(text)) : std::nullopt;
}

/// FENESTRA_BRIEF; 1 if unset.
inline std::uint64_t slowdownFactor() {
  static const std::uint64_t factor =
      std::max<std::uint64_t>(1, readEnvironmentNumber("FENESTRA_BRIEF").value_or(1));
  return factor;
}

/// Sample count of a test without a long version; smaller in a slow build.
template <typename Count>
Count reduceSamples(Count samples) {
  const auto count = static_cast<std::uint64_t>(samples);
  return static_cast<Count>((count + slowdownFactor() - 1) / slowdownFactor());
}

/// Sample count of a test; the long version takes 16 times as many, for a quarter of the error.
template <typename Count>
Count scaleSamples(Count samples) {
  return static_cast<Count>(
      reduceSamples(static_cast<std::uint64_t>(samples) * (isLongRun() ? 16 : 1)));
}

/// Largest standard error at which a test is still sensitive; larger in a slow build, which takes
/// fewer samples.
inline double relaxError(double error) {
  return error * std::sqrt(static_cast<double>(slowdownFactor()));
}

/// FENESTRA_SEED; 1 if unset.
inline std::uint64_t seedBase() {
  static const std::uint64_t base = readEnvironmentNumber("FENESTRA_SEED").value_or(1);
  return base;
}

/// Seed of a test for this run's seed base; `seed` itself for base 1.
inline std::uint64_t shiftSeed(std::uint64_t seed) {
  return seed + 1000003 * (seedBase() - 1);
}

} // namespace fenestra::core::testing
