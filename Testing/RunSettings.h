#pragma once
// Environment variables of a test run:
//   FENESTRA_LONG          set: run the long version
//   FENESTRA_BRIEF         divisor of sample counts, for slow builds
//   FENESTRA_SEED          number that selects other seeds
//   FENESTRA_COMBINATIONS  number of combinations to test of the matrix, for slow builds
//   FENESTRA_MUTATIONS     comma-separated names of the mutations to test
//   FENESTRA_REPORT        folder for fragments of the report

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>

namespace fenestra::testing {

inline bool isLongRun() {
  static const bool isLong = std::getenv("FENESTRA_LONG") != nullptr;
  return isLong;
}

inline std::optional<std::uint64_t> readEnvironmentNumber(const char* name) {
  const char* text = std::getenv(name);
  return text ? std::optional<std::uint64_t>(std::stoull(text)) : std::nullopt;
}

inline std::uint64_t sampleDivisor() {
  static const std::uint64_t sampleDivisor =
      std::max<std::uint64_t>(1, readEnvironmentNumber("FENESTRA_BRIEF").value_or(1));
  return sampleDivisor;
}

/// Sample count of a test without a long version.
template <typename Count>
Count reduceSamples(Count samples) {
  const auto count = static_cast<std::uint64_t>(samples);
  return static_cast<Count>((count + sampleDivisor() - 1) / sampleDivisor());
}

/// Sample count of a test; the long version takes 16 times as many, for a quarter of the error.
template <typename Count>
Count scaleSamples(Count samples) {
  return static_cast<Count>(
      reduceSamples(static_cast<std::uint64_t>(samples) * (isLongRun() ? 16 : 1)));
}

/// Largest standard error at which a test is still sensitive; larger in a brief run.
inline double relaxError(double error) {
  return error * std::sqrt(static_cast<double>(sampleDivisor()));
}

/// FENESTRA_SEED; 1 if unset.
inline std::uint64_t seedBase() {
  static const std::uint64_t base = readEnvironmentNumber("FENESTRA_SEED").value_or(1);
  return base;
}

/// Seed of a test, shifted by the seed base.
inline std::uint64_t shiftSeed(std::uint64_t seed) {
  return seed + 1000003 * (seedBase() - 1);
}

inline std::optional<std::filesystem::path> reportFolder() {
  const char* folder = std::getenv("FENESTRA_REPORT");
  if (!folder)
    return std::nullopt;
  std::filesystem::create_directories(folder);
  return folder;
}

} // namespace fenestra::testing
