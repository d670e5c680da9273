#pragma once
// Table of a batch. Each row is a case: its input, and options of `fenestra render`.

#include "program/RenderOptions.h"

namespace fenestra::core {

/// Case of a batch.
struct BatchRow {
  std::string name;
  std::vector<std::string> arguments; ///< "--name=value"; file names include the table's folder
  std::string input;
  std::string label; ///< the row's values, for the contact sheet
};

/// Syntax of batch: its own options, and those of render that the image depends on, for all rows.
const CommandSyntax& batchSyntax();

/// Reads a CSV table (parseCsv). Its columns are `name`, `input` and options of render; an empty
/// cell sets no option. Options in `common` apply to rows without a value of their own. Throws
/// Error (input), with the line number: for unknown or duplicate columns, duplicate or unportable
/// names, and more than 10,000 rows. Each row's own process checks its option values.
std::vector<BatchRow> readBatchTable(const std::filesystem::path& path, const OptionValues& common);

} // namespace fenestra::core
