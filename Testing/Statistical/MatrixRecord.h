#pragma once
// Report of a run over the matrix.

#include "Comparison.h"

namespace fenestra::testing {

/// Writes matrix.md (tables) and probabilities.svg (histograms) if a report is requested
/// (RunSettings.h).
void recordMatrix(const std::vector<Outcome>& outcomes, const std::vector<HypothesisTest>& tests,
                  const MatrixSettings& settings);

} // namespace fenestra::testing
