#pragma once
// What the statistical suite leaves behind: fragments of the report, in the folder that
// FENESTRA_REPORT names in the environment. Without it nothing is written.

#include "Comparison.h"

#include <filesystem>
#include <optional>

namespace fenestra::testing {

std::optional<std::filesystem::path> reportFolder();

/// matrix.md (tables) and probabilities.svg (histograms).
void recordMatrix(const std::vector<Outcome>& outcomes, const std::vector<Verdict>& verdicts,
                  const MatrixSettings& settings);

} // namespace fenestra::testing
