#pragma once
// Tables of comma-separated values (RFC 4180), in and out.

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace fenestra {

/// Record of a table.
struct CsvRecord {
  std::size_t line = 0; ///< in the file, from 1, where the record begins
  std::vector<std::string> fields;
};

/// Records of a table, blank lines left out. Lines end in LF, CR LF or CR; a byte order mark is
/// dropped; semicolons separate fields where the first line has some and no comma, as spreadsheets
/// write them in half of Europe. A quote within an unquoted field stands for itself. Throws Error
/// (input) for a quoted field that does not end or that is followed by more, and for more than a
/// million fields. `source`: name in messages.
std::vector<CsvRecord> parseCsv(std::string_view text, const std::string& source);

/// Line of a table, with its end. A text that a spreadsheet would take for a formula is preceded by
/// an apostrophe.
std::string formatCsvLine(const std::vector<std::string>& fields);

} // namespace fenestra
