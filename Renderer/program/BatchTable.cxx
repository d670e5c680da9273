#include "program/BatchTable.h"

#include "base/Error.h"
#include "files/formats/Csv.h"
#include "io/JsonNode.h"
#include "io/MessageText.h"
#include "program/CommandLine.h"
#include "program/Quality.h"

#include <algorithm>
#include <set>

namespace fenestra::core {
namespace {

namespace fs = std::filesystem;

constexpr const char* batchGroup = "Batch";
constexpr const char* nameColumn = "name";
constexpr const char* inputColumn = "input";

const Option batchTable[] = {
    {{"output", 'o'},
     "DIR",
     batchGroup,
     "Folder for one folder per row, study.csv and study.png [the table's name without .csv]"},
    {"workers", "N", batchGroup, "Rows rendered at a time, 1 to 256; they divide the threads",
     ValueSpec::integer(1, 256).withDefault("1")},
    {"formats", "L,...", batchGroup, "Images per row beside the .png: exr, nrrd, tif [none]",
     ValueSpec::list()},
    {"rows", "K/N", batchGroup,
     "Only rows K, K+N, K+2N, ... for one of N machines; afterward the same command without "
     "--rows writes study.csv and study.png [all]"},
    {"restart", "", batchGroup, "Render all rows again, replacing existing files"},
};

/// Throws Error (input) unless the name is a valid folder name on every system, and no formula of a
/// spreadsheet.
void requireFolderName(const std::string& name, const std::string& source,
                       const std::string& place) {
  constexpr std::size_t longest = 100; // bytes; leaves room for extensions and temporary names
  constexpr std::string_view notFirst = ".-=+@ '", notLast = ". ";
  const bool isPortable = !name.empty() && name.size() <= longest && toOneLine(name) == name &&
                          name.find_first_of("/\\:*?\"<>|") == name.npos &&
                          notFirst.find(name.front()) == notFirst.npos &&
                          notLast.find(name.back()) == notLast.npos;
  if (!isPortable)
    throw inputError(source, place, ": '", fenestra::core::sanitize(name),
                     "' is not a valid folder name; use at most 100 letters, digits, blanks, dots, "
                     "- and _, beginning with a letter, digit or _");
}

/// True if the option may have several columns.
bool canHaveColumns(const Option& option) {
  return option.spec.canRepeat || option.spec.type == "string-vector";
}

/// Options of the columns; null: name, input. Throws Error (input).
std::vector<const Option*> parseColumns(const CsvRecord& head, const std::string& source) {
  std::vector<std::string> known = {nameColumn, inputColumn};
  for (const Option& option : renderSyntax.options)
    if (isImageOption(option))
      known.push_back(option.name);
  std::vector<const Option*> columns;
  std::set<std::string> names;
  for (const std::string& name : head.fields) {
    const Option* const option = findOption(renderSyntax.options, name);
    const bool isKnown = option ? isImageOption(*option) : std::ranges::count(known, name) > 0;
    if (!isKnown) {
      const std::string likely = findNearest(toLower(name), known);
      throw inputError(source, "line ", head.line, ": '", fenestra::core::sanitize(name),
                       "' is no valid column",
                       likely.empty() ? "; columns are name, input and options of fenestra render"
                                      : "; did you mean " + likely + "?");
    }
    if (!names.insert(option ? option->name : name).second && !(option && canHaveColumns(*option)))
      throw inputError(source, "line ", head.line, ": duplicate column '", name, "'; remove one");
    columns.push_back(option);
  }
  for (const char* required : {nameColumn, inputColumn})
    if (!names.contains(required))
      throw inputError(source, "line ", head.line, ": column '", required, "' is missing; add it");
  return columns;
}

/// File that a cell names, relative to the working directory; the cell itself if it names none. A
/// name like a file's is looked up beside the table, never in the working directory.
std::string resolveFile(const std::string& cell, const fs::path& folder) {
  std::error_code failed;
  const fs::path beside = folder / cell;
  const bool isName = cell.find_first_of("./") == cell.npos;
  if (isName || (!fs::exists(beside, failed) && !fs::exists(cell, failed)))
    return cell;
  return beside.string();
}

/// Reads the rows in sequence.
class TableReader {
public:
  TableReader(const fs::path& path, const CsvRecord& head, const OptionValues& common)
      : m_folder(path.parent_path()),
        m_source(path.string()),
        m_head(head),
        m_columns(parseColumns(head, m_source)),
        m_common(common) {}

  BatchRow row(const CsvRecord& record) {
    const std::string place = concat("line ", record.line);
    if (record.fields.size() != m_columns.size())
      throw inputError(m_source, place, ": has ", record.fields.size(), " fields, the first line ",
                       m_columns.size(), "; quote fields with commas, or add the missing ones");
    BatchRow row;
    OptionValues others = m_common;
    for (std::size_t i = 0; i < m_columns.size(); ++i) {
      const std::string cell(trim(record.fields[i]));
      if (!cell.empty())
        add(row, others, i, cell, place);
    }
    requireFolderName(row.name, m_source, place);
    if (row.input.empty())
      throw inputError(m_source, place, ": input is empty; name a file or folder");
    if (const auto [known, isNew] = m_lines.emplace(toLower(row.name), record.line); !isNew)
      throw inputError(m_source, place, ": has the same name as line ", known->second, ", '",
                       row.name, "'; rename one");
    const std::vector<std::string> rest = others.arguments();
    row.arguments.insert(row.arguments.end(), rest.begin(), rest.end());
    return row;
  }

private:
  void add(BatchRow& row, OptionValues& others, std::size_t column, const std::string& cell,
           const std::string& place) {
    if (toOneLine(cell) != cell)
      throw inputError(m_source, place, ", ", m_head.fields[column],
                       ": contains a line break or invalid UTF-8; write it on one line, in UTF-8");
    const Option* const option = m_columns[column];
    if (!option && m_head.fields[column] == nameColumn)
      row.name = cell;
    else if (!option)
      row.input = (m_folder / cell).string();
    else {
      const bool namesFile = option->canNameFile();
      row.arguments.push_back(
          concat("--", option->name, "=", namesFile ? resolveFile(cell, m_folder) : cell));
      others.remove(option->name);
      if (option->name == "quality")
        removeQualityOptions(others);
      if (!namesFile || cell.find_first_of("./") == cell.npos)
        row.label += (row.label.empty() ? "" : ", ") + cell;
    }
  }

  fs::path m_folder;
  std::string m_source;
  const CsvRecord& m_head;
  std::vector<const Option*> m_columns;
  const OptionValues& m_common;
  std::map<std::string, std::size_t> m_lines; ///< by name in lower case
};

} // namespace

const CommandSyntax& batchSyntax() {
  static const std::vector<Option> options = [] {
    constexpr std::string_view shared[] = {"layers", "threads", "progress", "quiet", "verbose"};
    std::vector<Option> all(std::begin(batchTable), std::end(batchTable));
    for (const Option& option : renderSyntax.options)
      if (isImageOption(option) || std::ranges::count(shared, option.name) > 0)
        all.push_back(option);
    return all;
  }();
  static const CommandSyntax syntax = {
      "batch",
      "Renders a table of cases, one per row, each in a process of its own, so that a row that "
      "fails does not end the others. The columns are name, input and options of fenestra render, "
      "such as segmentation, preset or view. An empty cell sets no option, and files are relative "
      "to the table. The row liver gives DIR/liver/liver.png, its measurements liver.json and the "
      "manifest liver.study.json. The same command resumes after a stop, and renders rows again "
      "that failed or whose options or files have changed. At the end study.csv lists status, "
      "seconds, noise and measurements of each row, and the contact sheets study.png, study-2.png "
      "and so on show 36 images each. Options of fenestra render on the command line apply to all "
      "rows whose cell is empty.",
      {{"TABLE", "Table of the rows (.csv); its first line names the columns"}},
      options,
      {},
      "Render a table of cases, one per row",
      "batch cases.csv --output results --workers 2 --quality normal",
  };
  return syntax;
}

std::vector<BatchRow> readBatchTable(const fs::path& path, const OptionValues& common) {
  constexpr std::size_t mostRows = 10'000;
  const std::vector<CsvRecord> records = parseCsv(readText(path), path.string());
  if (records.size() < 2)
    throw inputError(path, "has no row; write a line of column names (name,input,…), then one line "
                           "per case");
  if (records.size() > mostRows + 1)
    throw inputError(path, "has more than ", mostRows, " rows; split it");
  TableReader reader(path, records.front(), common);
  std::vector<BatchRow> rows;
  for (const CsvRecord& record : records) {
    const auto isEmpty = [](const std::string& field) { return trim(field).empty(); };
    if (&record != &records.front() && !std::ranges::all_of(record.fields, isEmpty))
      rows.push_back(reader.row(record));
  }
  return rows;
}

} // namespace fenestra::core
