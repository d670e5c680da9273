#pragma once
// What the environment asks of a run of the tests:
//   FENESTRA_LONG          set: the long version
//   FENESTRA_BRIEF         a number: divides how many samples are drawn, for slow builds
//   FENESTRA_SEED          a number: other seeds
//   FENESTRA_COMBINATIONS  a number: how many of the matrix, for slow builds
//   FENESTRA_REPORT        a folder: leave fragments of the report there

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

inline std::optional<std::uint64_t> numberFromEnvironment(const char* name) {
  const char* text = std::getenv(name);
  return text ? std::optional<std::uint64_t>(std::stoull(text)) : std::nullopt;
}

inline std::uint64_t brevity() {
  static const std::uint64_t brevity =
      std::max<std::uint64_t>(1, numberFromEnvironment("FENESTRA_BRIEF").value_or(1));
  return brevity;
}

/// Samples of a test that has no long version.
template <typename Count>
Count briefly(Count samples) {
  const auto whole = static_cast<std::uint64_t>(samples);
  return static_cast<Count>((whole + brevity() - 1) / brevity());
}

/// Samples of a test: in the long version 16 times as many, for a quarter of the error.
template <typename Count>
Count budget(Count samples) {
  return static_cast<Count>(briefly(static_cast<std::uint64_t>(samples) * (isLongRun() ? 16 : 1)));
}

/// The greatest error that a test allows itself, lest it find nothing: wider in a brief run.
inline double allowedError(double error) {
  return error * std::sqrt(static_cast<double>(brevity()));
}

/// 1 where nothing else is asked for.
inline std::uint64_t seedBase() {
  static const std::uint64_t base = numberFromEnvironment("FENESTRA_SEED").value_or(1);
  return base;
}

/// A test's own seed, moved by the seed base.
inline std::uint64_t seeded(std::uint64_t seed) {
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
