#include "program/RowManifest.h"

#include "base/Error.h"
#include "files/images/ImageWriter.h"
#include "files/medical/ReferencedFiles.h"
#include "io/Digest.h"
#include "io/InputRegistry.h"
#include "io/platform/SystemErrors.h"
#include "program/ErrorAdvice.h"
#include "program/FileNames.h"
#include "program/UsageError.h"

#include <algorithm>
#include <utility>

namespace fenestra::core {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr int maxRowFiles = 20;

fs::path makeRowPath(const BatchRow& row, const fs::path& folder, const std::string& ending) {
  return folder / row.name / (row.name + ending);
}

std::vector<fs::path> listRowImages(const BatchRow& row, const fs::path& folder,
                                    const std::vector<std::string>& formats) {
  std::vector<fs::path> pictures = {rowImagePath(row, folder)};
  for (const std::string& format : formats)
    pictures.push_back(makeRowPath(row, folder, "." + format));
  return pictures;
}

/// Arguments that a row's results depend on. Its folder must exist.
std::vector<std::string> listArguments(const BatchRow& row, const fs::path& folder,
                                       const std::vector<std::string>& formats) {
  std::vector<std::string> arguments = row.arguments;
  if (!formats.empty())
    arguments.push_back("--formats=" + join(formats, ","));
  arguments.push_back(row.input);
  return toRelativeArguments(arguments, renderSyntax.options, folder / row.name);
}

/// Input files of a finished row: those in its arguments and statistics, files that their headers
/// name, and the files of an input folder.
std::set<fs::path> listRowInputs(const BatchRow& row, const fs::path& stats) {
  const std::string name = stats.string();
  const json document = parseJson(readText(stats), name);
  std::set<fs::path> files = {row.input};
  for (const JsonNode& file : JsonNode(document, name).at("filesRead").elements())
    files.insert(stats.parent_path() / file.text());
  for (const std::string& flag : row.arguments)
    files.insert(flag.substr(flag.find('=') + 1)); // a value that is no file is skipped later
  std::error_code failed;
  if (fs::is_directory(row.input, failed))
    for (const auto& entry : fs::directory_iterator(row.input, failed))
      files.insert(entry.path());
  for (const fs::path& file : std::set<fs::path>(files))
    for (const fs::path& named : findReferencedFiles(file))
      files.insert(named);
  return files;
}

/// Throws Error (input).
ContentDigest readFileState(const fs::path& path) {
  std::error_code failed;
  const std::uintmax_t bytes = fs::file_size(path, failed);
  if (failed)
    throw readError(path, failed.value(), "check its disk");
  return {bytes, computeDigest(path)};
}

/// Outcome in the manifest's entry. Throws Error (input).
json readOutcome(const JsonNode& entry) {
  json more = {{"status", entry.at("status").number(0, 255)},
               {"seconds", entry.at("seconds").number(0.0, 1e12)}};
  if (const auto error = entry.find("error"))
    more["error"] = error->text();
  return more;
}

} // namespace

fs::path rowImagePath(const BatchRow& row, const fs::path& folder) {
  return makeRowPath(row, folder, ".png");
}

fs::path rowStatsPath(const BatchRow& row, const fs::path& folder) {
  return makeRowPath(row, folder, ".json");
}

RowManifest::RowManifest(const BatchRow& row, const fs::path& folder,
                         const std::vector<std::string>& formats, bool restart)
    : m_row(row),
      m_folder(folder / row.name),
      m_made(m_folder),
      m_images(listRowImages(row, folder, formats)),
      m_checkpoint(makeRowPath(row, folder, ".film")),
      m_lock(makeRowPath(row, folder, ".study.json")),
      m_manifest(makeRowPath(row, folder, ".study.json"), "row",
                 listArguments(row, folder, formats)) {
  if (!m_lock.isHeld())
    throw usageError(m_manifest.path(),
                     ": another batch is rendering this row; wait for it, or use another --output");
  read(restart);
  m_manifest.declare(m_outputs);
}

void RowManifest::read(bool restart) {
  if (restart)
    return;
  const std::optional<FileId> there = fileId(m_manifest.path());
  if (!there) {
    std::vector<fs::path> unknown = files();
    if (fileExists(m_checkpoint))
      unknown.push_back(m_checkpoint);
    for (const fs::path& file : unknown)
      throw usageError(file, ": already exists, and no ", m_manifest.path().filename(),
                       " describes it; move it away, or add --restart to replace it");
    return;
  }
  m_manifest.readRequest(maxRowFiles);
  unregisterInput(*there); // since the manifest is also an output
  m_manifest.addInputs(m_manifest.recordedInputs());
  m_manifest.readItems(
      1, [this](int) { return files(); }, readOutcome);
  const bool isSame = !m_manifest.findDifference();
  if (const auto& items = m_manifest.finished(); // the row is item 0, the only one
      isSame && items.contains(0) && items.at(0).extra.at("status") == 0)
    m_finished = {RowOutcome::State::done, 0, items.at(0).extra.at("seconds")};
  m_manifest.clearItems();
  m_isResumed = isSame && !m_finished && fileExists(m_checkpoint);
  if (m_finished)
    removeCheckpoint();
}

std::vector<fs::path> RowManifest::files() const {
  std::vector<fs::path> files;
  std::error_code failed;
  for (const fs::path& picture : m_images)
    for (const fs::path& file : listImageFiles(picture))
      if (fs::exists(file, failed))
        files.push_back(file);
  if (const fs::path stats = rowStatsPath(m_row, m_folder.parent_path()); fs::exists(stats, failed))
    files.push_back(stats);
  return files;
}

std::vector<std::string> RowManifest::arguments(int threads) const {
  std::vector<std::string> words = {"render"};
  words.insert(words.end(), m_row.arguments.begin(), m_row.arguments.end());
  for (const fs::path& picture : m_images)
    words.push_back(concat("--output=", picture));
  words.push_back(concat("--stats-json=", rowStatsPath(m_row, m_folder.parent_path())));
  words.push_back(concat("--checkpoint=", m_checkpoint));
  words.push_back(concat("--threads=", threads));
  words.insert(words.end(), {"--quiet", "--", m_row.input});
  return words;
}

void RowManifest::begin() {
  m_manifest.addInputs({});
  m_manifest.write(m_outputs);
  if (!m_isResumed)
    removeCheckpoint();
}

bool RowManifest::discardCheckpoint(const RowOutcome& outcome) {
  const bool isRefused = outcome.status == exitStatus(ErrorKind::request) ||
                         outcome.status == exitStatus(ErrorKind::input);
  if (!isRefused || !std::exchange(m_isResumed, false))
    return false;
  removeCheckpoint();
  return true;
}

void RowManifest::removeCheckpoint() const {
  std::error_code failed;
  fs::remove(m_checkpoint, failed);
  if (failed)
    throw outputError(m_checkpoint, "cannot be removed: ", systemMessage(failed.value()),
                      "; remove it");
}

void RowManifest::finish(const RowOutcome& outcome) {
  json more = {{"status", outcome.status}, {"seconds", outcome.seconds}};
  if (!outcome.error.empty())
    more["error"] = outcome.error;
  Manifest::WrittenFiles written;
  if (outcome.state == RowOutcome::State::done) {
    m_manifest.addInputs(listRowInputs(m_row, rowStatsPath(m_row, m_folder.parent_path())));
    for (const fs::path& file : files())
      written.emplace_back(file, readFileState(file));
  }
  m_manifest.finish(0, written, more, m_outputs);
  if (outcome.state == RowOutcome::State::done)
    removeCheckpoint();
}

} // namespace fenestra::core
