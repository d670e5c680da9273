#pragma once
// Results of a whole study: a summary for programs, contact sheets for people.

#include "program/RowManifest.h"

namespace fenestra {

/// A study's rows, what came of each, and where they lie.
struct BatchResults {
  std::filesystem::path table, folder;
  std::vector<BatchRow> rows;
  std::vector<RowOutcome> outcomes; ///< of the rows

  std::size_t count(RowOutcome::State state) const;
};

/// Declares summary and sheets; each replaces only a file that a study wrote. Throws the errors of
/// Outputs.
void declareResults(const BatchResults& results, Outputs& outputs);

/// Writes DIR/study.csv: a line a row with name, status, exit status, error line, picture, seconds,
/// and all numbers of its statistics; and DIR/study.png, the pictures of the rows that are done
/// with their names, and what is wrong with the others (study-2.png and so on beyond 36). The
/// caller commits them. Throws Error (output).
void writeResults(const BatchResults& results, Outputs& outputs);

} // namespace fenestra
