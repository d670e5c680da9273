#pragma once
// Cases of cases.txt, their renders, and the comparison of a render with its baseline.

#include "image/Image.h"

#include <cstdint>
#include <filesystem>
#include <ostream>
#include <string>
#include <vector>

namespace fenestra::testing {

struct RegressionCase {
  std::string name;
  std::string baseline;               ///< name of the case that owns the baseline; may be this case
  std::uint64_t samples = 0;          ///< samples a pixel of the test
  std::vector<std::string> arguments; ///< arguments of `fenestra`, run in Testing/Data
};

/// GoogleTest's text of a case.
inline void PrintTo(const RegressionCase& c, std::ostream* out) {
  for (const std::string& argument : c.arguments)
    *out << argument << ' ';
}

/// Throws std::runtime_error for an invalid table.
std::vector<RegressionCase> readCases();

/// Testing/Data, and the baseline of a case in that folder.
std::filesystem::path dataFolder();
std::filesystem::path baselinePath(const RegressionCase& c);

/// Runs the executable in `folder` (Testing/Data, or a copy with a planted fault), writes the
/// picture to `output` and returns it. Throws std::runtime_error with the executable's error text.
Image renderCase(const RegressionCase& c, std::uint64_t seed, std::uint64_t samples,
                 const std::filesystem::path& folder, const std::filesystem::path& output);

/// Probability of the largest difference at three scales: pixels detect what has moved, the mean a
/// small overall change, tiles of 8 pixels anything in between.
struct Agreement {
  double pixels = 0.0, tiles = 0.0, mean = 0.0;

  /// Probability of all three scales together (Šidák 1967).
  double probability() const;
  /// True if the difference may be chance; false once in ten thousand renders of one scene.
  bool holds() const { return probability() >= 1e-4; }
};

Agreement agreement(const Image& image, const Image& baseline);

} // namespace fenestra::testing
