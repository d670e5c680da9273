// usage: MakeBaselines [CASE...]: renders the baselines of these cases, or of all.
#include "Cases.h"

#include <cstdio>
#include <exception>
#include <set>

namespace {

/// Seed that is not used by any test.
constexpr std::uint64_t seed = 20001;
/// Samples of a baseline per sample of its test: noise of the baseline adds 6 % to the difference.
constexpr std::uint64_t moreSamples = 8;

} // namespace

int main(int argc, char** argv) {
  using namespace fenestra::core::testing;
  try {
    const std::set<std::string> wanted(argv + 1, argv + argc);
    for (const RegressionCase& c : readCases())
      if (c.baseline == c.name && (wanted.empty() || wanted.contains(c.name))) {
        renderCase(c, seed, moreSamples * c.samples, dataFolder(), baselinePath(c));
        std::printf("%s\n", c.name.c_str());
      }
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "MakeBaselines: %s\n", error.what());
    return 4;
  }
}
