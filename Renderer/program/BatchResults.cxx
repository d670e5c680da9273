#include "program/BatchResults.h"

#include "files/formats/Csv.h"
#include "files/images/ContactSheet.h"
#include "files/images/ImageWriter.h"

#include <algorithm>
#include <fstream>

namespace fenestra::core {
namespace {

namespace fs = std::filesystem;
using State = RowOutcome::State;

const char* formatState(State state) {
  switch (state) {
  case State::done:
    return "done";
  case State::failed:
    return "failed";
  case State::stopped:
    return "stopped";
  default:
    return "missing";
  }
}

fs::path makeSummaryPath(const BatchResults& results) {
  return results.folder / "study.csv";
}

std::vector<fs::path> makeSheetPaths(const BatchResults& results) {
  std::vector<fs::path> paths = {results.folder / "study.png"};
  while (paths.size() * maxSheetEntries < results.rows.size())
    paths.push_back(results.folder / concat("study-", paths.size() + 1, ".png"));
  return paths;
}

const std::vector<std::string> firstColumns = {"name",  "status",  "exitStatus",
                                               "error", "picture", "seconds"};

/// True for a summary written by any version.
bool isSummary(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::string line;
  const std::string head = formatCsvLine(firstColumns);
  return std::getline(file, line) && line.starts_with(head.substr(0, head.size() - 2)); // CR LF
}

/// Numbers of a row's statistics (--stats-json) by JSON path, as "samplesPerPixel.mean"; lists are
/// omitted.
using Measures = std::map<std::string, double>;

void addMeasures(const nlohmann::json& json, const std::string& place, Measures& measures) {
  for (const auto& [key, value] : json.items()) {
    const std::string name = place.empty() ? key : concat(place, ".", key);
    if (value.is_number())
      measures[name] = value.get<double>();
    else if (value.is_object())
      addMeasures(value, name, measures);
  }
}

/// Empty without valid statistics.
Measures readMeasures(const BatchRow& row, const fs::path& folder) {
  Measures measures;
  try {
    const fs::path path = rowStatsPath(row, folder);
    addMeasures(parseJson(readText(path), path.string()), "", measures);
  } catch (const Error&) { // missing or damaged
    measures.clear();
  }
  return measures;
}

std::string formatSummary(const BatchResults& results, const std::vector<Measures>& measures) {
  std::vector<std::string> columns = {"noise", "noiseFiltered", "focusCoverage"};
  for (const Measures& row : measures)
    for (const auto& [name, value] : row)
      if (std::ranges::find(columns, name) == columns.end())
        columns.push_back(name);
  std::vector<std::string> head = firstColumns;
  head.insert(head.end(), columns.begin(), columns.end());
  std::string text = formatCsvLine(head);
  for (std::size_t i = 0; i < results.rows.size(); ++i) {
    const RowOutcome& outcome = results.outcomes[i];
    const fs::path picture = rowImagePath(results.rows[i], results.folder);
    std::vector<std::string> fields = {
        results.rows[i].name,
        formatState(outcome.state),
        outcome.state == State::missing ? "" : concat(outcome.status),
        outcome.error,
        outcome.state == State::done ? picture.lexically_relative(results.folder).string() : "",
        outcome.state == State::missing ? "" : toString(outcome.seconds)};
    for (const std::string& column : columns) {
      const auto found = measures[i].find(column);
      fields.push_back(found == measures[i].end() ? "" : toString(found->second, 9));
    }
    text += formatCsvLine(fields);
  }
  return text;
}

SheetEntry makeSheetEntry(const BatchRow& row, const RowOutcome& outcome, const Measures& measures,
                          const fs::path& folder) {
  SheetEntry entry{.name = row.name, .lines = {row.label}};
  if (outcome.state == State::done)
    entry.image = rowImagePath(row, folder);
  if (outcome.state != State::done)
    entry.problem =
        concat(formatState(outcome.state), outcome.error.empty() ? "" : ": ", outcome.error);
  std::vector<std::string> facts;
  const auto findMeasure = [&measures](const char* name) {
    const auto found = measures.find(name);
    return found == measures.end() ? std::optional<double>() : found->second;
  };
  if (const auto coverage = findMeasure("focusCoverage"))
    facts.push_back(concat(std::lround(100.0 * *coverage), " % of the focus visible"));
  for (const char* name : {"noiseDenoised", "noiseFiltered", "noise"}) // the second by version 0.1
    if (const auto noise = findMeasure(name)) {
      facts.push_back("noise " + toString(*noise, 2));
      break;
    }
  entry.lines.push_back(join(facts, ", "));
  return entry;
}

} // namespace

std::size_t BatchResults::count(State state) const {
  return static_cast<std::size_t>(std::ranges::count(outcomes, state, &RowOutcome::state));
}

void declareResults(const BatchResults& results, Outputs& outputs) {
  outputs.add(makeSummaryPath(results), isSummary);
  for (const fs::path& path : makeSheetPaths(results))
    declareImage(path, outputs, NameOrigin::standard);
}

void writeResults(const BatchResults& results, Outputs& outputs) {
  std::vector<Measures> measures;
  std::vector<SheetEntry> entries;
  for (std::size_t i = 0; i < results.rows.size(); ++i) {
    const BatchRow& row = results.rows[i];
    const RowOutcome& outcome = results.outcomes[i];
    measures.push_back(outcome.state == State::done ? readMeasures(row, results.folder)
                                                    : Measures());
    entries.push_back(makeSheetEntry(row, outcome, measures.back(), results.folder));
  }
  outputs.write(makeSummaryPath(results), formatSummary(results, measures));
  const std::vector<fs::path> paths = makeSheetPaths(results);
  for (std::size_t i = 0; i < paths.size(); ++i) {
    std::string facts = concat(results.rows.size(), " cases");
    for (const State state : {State::done, State::failed, State::stopped, State::missing})
      if (const std::size_t count = results.count(state); count > 0)
        facts += concat(", ", count, " ", formatState(state));
    if (paths.size() > 1)
      facts += concat(", sheet ", i + 1, " of ", paths.size());
    const std::size_t first = i * maxSheetEntries;
    const auto shown =
        std::span(entries).subspan(first, std::min(maxSheetEntries, entries.size() - first));
    writeImage(makeContactSheet(results.table.stem().string(), facts, shown), {}, paths[i], outputs,
               {DisplayView::standard});
  }
}

} // namespace fenestra::core
