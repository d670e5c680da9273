#pragma once
// The cases of cases.txt, how they are rendered, and when a render agrees with its baseline.

#include "image/Image.h"

#include <cstdint>
#include <filesystem>
#include <ostream>
#include <string>
#include <vector>

namespace fenestra::testing {

struct RegressionCase {
  std::string name;
  std::string baseline;               ///< name of the case whose baseline it shares, or its own
  std::uint64_t samples = 0;          ///< a pixel, of the test
  std::vector<std::string> arguments; ///< of `fenestra`, from Testing/Data
};

/// What GoogleTest shows of a case.
inline void PrintTo(const RegressionCase& c, std::ostream* out) {
  for (const std::string& argument : c.arguments)
    *out << argument << ' ';
}

/// Throws std::runtime_error where the table is not one.
std::vector<RegressionCase> readCases();

/// Testing/Data, and in it the baseline of a case.
std::filesystem::path dataFolder();
std::filesystem::path baselinePath(const RegressionCase& c);

/// Runs the executable in `folder` (Testing/Data, or a copy with something planted), writes the
/// picture to `output` and returns it. Throws std::runtime_error with what the executable said.
Image renderCase(const RegressionCase& c, std::uint64_t seed, std::uint64_t samples,
                 const std::filesystem::path& folder, const std::filesystem::path& output);

/// How probable the largest difference is, at three scales: pixels find what has moved, the mean of
/// the picture finds what has become a little more or less, tiles of 8 pixels what lies between.
struct Agreement {
  double pixels = 0.0, tiles = 0.0, mean = 0.0;

  /// Of all three together (Šidák 1967).
  double probability() const;
  /// Renders of one scene fail this once in ten thousand, by chance.
  bool holds() const { return probability() >= 1e-4; }
};

Agreement agreement(const Image& image, const Image& baseline);

} // namespace fenestra::testing
