#include "program/StudyRecord.h"

#include "base/Error.h"
#include "base/safe/Digest.h"
#include "base/safe/Inputs.h"
#include "base/safe/SystemCalls.h"
#include "files/medical/NamedFiles.h"
#include "files/pictures/ImageWriter.h"
#include "program/FileNames.h"

#include <algorithm>
#include <utility>

namespace fenestra {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr int mostRowFiles = 20;

fs::path rowFile(const StudyRow& row, const fs::path& folder, const std::string& ending) {
  return folder / row.name / (row.name + ending);
}

std::vector<fs::path> rowPictures(const StudyRow& row, const fs::path& folder,
                                  const std::vector<std::string>& formats) {
  std::vector<fs::path> pictures = {rowPicture(row, folder)};
  for (const std::string& format : formats)
    pictures.push_back(rowFile(row, folder, "." + format));
  return pictures;
}

/// Arguments on which a row depends; its folder exists.
std::vector<std::string> recordedArguments(const StudyRow& row, const fs::path& folder,
                                           const std::vector<std::string>& formats) {
  std::vector<std::string> arguments = row.flags;
  if (!formats.empty())
    arguments.push_back("--formats=" + join(formats, ","));
  arguments.push_back(row.input);
  return relativeArguments(arguments, renderSyntax.options, folder / row.name);
}

/// Input files of a row that is done: those of its arguments and statistics, what their headers
/// name, and the files of an input folder.
std::set<fs::path> inputsOf(const StudyRow& row, const fs::path& stats) {
  const std::string name = stats.string();
  const json document = parseJson(readText(stats), name);
  std::set<fs::path> files = {row.input};
  for (const JsonNode& file : JsonNode(document, name).at("filesRead").elements())
    files.insert(stats.parent_path() / file.text());
  for (const std::string& flag : row.flags)
    files.insert(flag.substr(flag.find('=') + 1)); // what is no file has no state
  std::error_code failed;
  if (fs::is_directory(row.input, failed))
    for (const auto& entry : fs::directory_iterator(row.input, failed))
      files.insert(entry.path());
  for (const fs::path& file : std::set<fs::path>(files))
    for (const fs::path& named : filesNamedBy(file))
      files.insert(named);
  return files;
}

/// Throws Error (input).
ContentState stateOfFile(const fs::path& path) {
  std::error_code failed;
  const std::uintmax_t bytes = fs::file_size(path, failed);
  if (failed)
    throw readError(path, failed.value(), "check its disk");
  return {bytes, digestOf(path)};
}

/// Outcome in the record's entry. Throws Error (input).
json checkedOutcome(const JsonNode& entry) {
  json more = {{"status", entry.at("status").numberIn(0, 255)},
               {"seconds", entry.at("seconds").numberIn(0.0, 1e12)}};
  if (const auto error = entry.find("error"))
    more["error"] = error->text();
  return more;
}

} // namespace

fs::path rowPicture(const StudyRow& row, const fs::path& folder) {
  return rowFile(row, folder, ".png");
}

fs::path rowStats(const StudyRow& row, const fs::path& folder) {
  return rowFile(row, folder, ".json");
}

StudyRecord::StudyRecord(const StudyRow& row, const fs::path& folder,
                         const std::vector<std::string>& formats, bool restart)
    : m_row(row),
      m_folder(folder / row.name),
      m_made(m_folder),
      m_pictures(rowPictures(row, folder, formats)),
      m_film(rowFile(row, folder, ".film")),
      m_lock(rowFile(row, folder, ".study.json")),
      m_record(rowFile(row, folder, ".study.json"), "row",
               recordedArguments(row, folder, formats)) {
  if (!m_lock.isHeld())
    throw usageError(m_record.path(),
                     ": another study is making this row; wait for it, or choose another --output");
  read(restart);
  m_record.declare(m_outputs);
}

void StudyRecord::read(bool restart) {
  if (restart)
    return;
  const std::optional<FileId> there = fileId(m_record.path());
  if (!there) {
    std::vector<fs::path> unknown = files();
    if (isThere(m_film))
      unknown.push_back(m_film);
    for (const fs::path& file : unknown)
      throw usageError(file, ": is there, and no ", m_record.path().filename(),
                       " tells what it is of; move it away, or add --restart to replace it");
    return;
  }
  m_record.readRequest(mostRowFiles);
  forgetInput(*there); // the record is rewritten, so it is no input
  m_record.addInputs(m_record.recordedInputs());
  m_record.readItems(
      1, [this](int) { return files(); }, checkedOutcome);
  const bool isSame = !m_record.findDifference();
  if (const auto& pieces = m_record.finished();
      isSame && pieces.contains(0) && pieces.at(0).extra.at("status") == 0)
    m_finished = {RowOutcome::State::done, 0, pieces.at(0).extra.at("seconds")};
  m_record.clearItems();
  m_goesOn = isSame && !m_finished && isThere(m_film);
  if (m_finished)
    removeFilm();
}

std::vector<fs::path> StudyRecord::files() const {
  std::vector<fs::path> files;
  std::error_code failed;
  for (const fs::path& picture : m_pictures)
    for (const fs::path& file : imageFiles(picture))
      if (fs::exists(file, failed))
        files.push_back(file);
  if (const fs::path stats = rowStats(m_row, m_folder.parent_path()); fs::exists(stats, failed))
    files.push_back(stats);
  return files;
}

std::vector<std::string> StudyRecord::arguments(int threads) const {
  std::vector<std::string> words = {"render"};
  words.insert(words.end(), m_row.flags.begin(), m_row.flags.end());
  for (const fs::path& picture : m_pictures)
    words.push_back(concat("--output=", picture));
  words.push_back(concat("--stats=", rowStats(m_row, m_folder.parent_path())));
  words.push_back(concat("--checkpoint=", m_film));
  words.push_back(concat("--threads=", threads));
  words.insert(words.end(), {"--progress=none", "--", m_row.input});
  return words;
}

void StudyRecord::begin() {
  m_record.addInputs({});
  m_record.write(m_outputs);
  if (!m_goesOn)
    removeFilm();
}

bool StudyRecord::beginsAnew(const RowOutcome& outcome) {
  const bool isRefused = outcome.status == static_cast<int>(ErrorKind::usage) ||
                         outcome.status == static_cast<int>(ErrorKind::input);
  if (!isRefused || !std::exchange(m_goesOn, false))
    return false;
  removeFilm();
  return true;
}

void StudyRecord::removeFilm() const {
  std::error_code failed;
  fs::remove(m_film, failed);
  if (failed)
    throw outputError(m_film, "cannot be removed: ", systemMessage(failed.value()), "; remove it");
}

void StudyRecord::finish(const RowOutcome& outcome) {
  json more = {{"status", outcome.status}, {"seconds", outcome.seconds}};
  if (!outcome.error.empty())
    more["error"] = outcome.error;
  Manifest::WrittenFiles written;
  if (outcome.state == RowOutcome::State::done) {
    m_record.addInputs(inputsOf(m_row, rowStats(m_row, m_folder.parent_path())));
    for (const fs::path& file : files())
      written.emplace_back(file, stateOfFile(file));
  }
  m_record.finish(0, written, more, m_outputs);
  if (outcome.state == RowOutcome::State::done)
    removeFilm();
}

} // namespace fenestra
