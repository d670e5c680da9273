#pragma once
// What a run over the matrix leaves behind.

#include "Comparison.h"

namespace fenestra::testing {

/// matrix.md (tables) and probabilities.svg (histograms), where a report is wanted (RunSettings.h).
void recordMatrix(const std::vector<Outcome>& outcomes, const std::vector<Verdict>& verdicts,
                  const MatrixSettings& settings);

} // namespace fenestra::testing
