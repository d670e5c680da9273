#pragma once
// Record of a run over the matrix.

#include "Comparison.h"

namespace fenestra::testing {

/// If a report is requested (RunSettings.h), writes matrix.csv (combinations), matrix-summary.csv
/// (hypothesis tests) and probabilities.svg (histograms).
void recordMatrix(const std::vector<Outcome>& outcomes, const std::vector<HypothesisTest>& tests,
                  const MatrixSettings& settings);

} // namespace fenestra::testing
