#pragma once
// Results of a complete batch: a summary table and contact sheets.

#include "program/RowManifest.h"

namespace fenestra::core {

/// Rows of a batch, their outcomes, and their folder.
struct BatchResults {
  std::filesystem::path table, folder;
  std::vector<BatchRow> rows;
  std::vector<RowOutcome> outcomes; ///< one per row

  std::size_t count(RowOutcome::State state) const;
};

/// Declares summary and sheets; each replaces only a file that a batch wrote. Throws the errors of
/// Outputs.
void declareResults(const BatchResults& results, Outputs& outputs);

/// Writes DIR/study.csv: per row its name, status, exit status, error message, image, seconds, and
/// all numbers of its statistics. Writes DIR/study.png: the images of finished rows with their
/// names, and the errors of the others (beyond 36 rows also study-2.png and so on). The caller
/// commits them. Throws Error (output).
void writeResults(const BatchResults& results, Outputs& outputs);

} // namespace fenestra::core
