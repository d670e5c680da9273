#pragma once
// Table of a study, a row a case: its flags as arguments of `fenestra render`.

#include "program/RenderOptions.h"

namespace fenestra {

/// Case of a study.
struct BatchRow {
  std::string name;
  std::vector<std::string>
      arguments; ///< "--name=value"; files of the table's folder by their paths
  std::string input;
  std::string label; ///< values in which the rows differ, for people
};

/// Syntax of study: own flags, and those of render that shape a picture, for all rows.
const CommandSyntax& batchSyntax();

/// Reads a table (parseCsv): columns `name` and `input`, others named as flags of render, empty
/// cells being flags that are not given. A flag in `common`, given for all rows, is left to the
/// rows that have no value of their own. Throws Error (input), naming the line: for unknown or
/// doubled columns, names that are no portable folder names, doubled names, more than 10,000 rows.
/// Values are not checked: a row's own run does that.
std::vector<BatchRow> readBatchTable(const std::filesystem::path& path, const OptionValues& common);

} // namespace fenestra
