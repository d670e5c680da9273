#pragma once
// Comma-separated tables (RFC 4180): parser and formatter.

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace fenestra::core {

/// Record (row) of a table.
struct CsvRecord {
  std::size_t line = 0; ///< line of the file, from 1, in which the record begins
  std::vector<std::string> fields;
};

/// Records of a table, without blank lines. Lines end in LF, CR LF or CR; a byte order mark is
/// dropped. Semicolons separate fields if the first line has some and no comma, as spreadsheets
/// write in many European locales. A quote within an unquoted field is literal. Throws Error
/// (input) for a quoted field without end or followed by text, and for more than a million fields.
/// `source`: name in messages.
std::vector<CsvRecord> parseCsv(std::string_view text, const std::string& source);

/// Line of a table, with its line end. A text that a spreadsheet would evaluate as a formula gets a
/// leading apostrophe.
std::string formatCsvLine(const std::vector<std::string>& fields);

} // namespace fenestra::core
