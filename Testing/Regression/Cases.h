#pragma once
// Regression cases (cases.txt): rendering one, and comparing the image with its baseline.

#include "image/Image.h"

#include <cstdint>
#include <filesystem>
#include <ostream>
#include <string>
#include <vector>

namespace fenestra::core::testing {

struct RegressionCase {
  std::string name;
  std::string baseline;               ///< name of the case whose baseline is used; may be this case
  std::uint64_t samples = 0;          ///< samples per pixel of the test
  std::vector<std::string> arguments; ///< arguments of `fenestra`, run in Testing/Data
};

/// Prints a case in messages of GoogleTest.
inline void PrintTo(const RegressionCase& c, std::ostream* out) {
  for (const std::string& argument : c.arguments)
    *out << argument << ' ';
}

/// Throws std::runtime_error for an invalid table.
std::vector<RegressionCase> readCases();

/// The folder Testing/Data, and the baseline of a case in it.
std::filesystem::path dataFolder();
std::filesystem::path baselinePath(const RegressionCase& c);

/// Runs the executable in `folder` (Testing/Data or a modified copy), writes the image to `output`
/// and returns it. Throws std::runtime_error with the executable's error message.
Image renderCase(const RegressionCase& c, std::uint64_t seed, std::uint64_t samples,
                 const std::filesystem::path& folder, const std::filesystem::path& output);

/// Probability of the largest difference at three scales. Pixels detect geometric changes, the mean
/// small global changes, and tiles of 8x8 pixels changes in between.
struct Agreement {
  double pixels = 0.0, tiles = 0.0, mean = 0.0;

  /// Combined probability of the three scales (Šidák 1967).
  double probability() const;
  /// True if the difference can be noise. Wrongly false for one in 10,000 renders.
  bool canBeNoise() const { return probability() >= 1e-4; }
};

Agreement compareWithBaseline(const Image& image, const Image& baseline);

} // namespace fenestra::core::testing
