#include "io/Outputs.h"

#include "base/Error.h"
#include "io/Digest.h"
#include "io/InputRegistry.h"
#include "io/platform/Locks.h"
#include "io/platform/OutputTarget.h"
#include "io/platform/TemporaryFile.h"

#include <algorithm>
#include <atomic>
#include <optional>
#include <set>
#include <utility>

namespace fenestra::core {
namespace {

namespace fs = std::filesystem;

std::atomic<bool> anyPlaced = false;

void requireNotInput(const fs::path& path, const std::optional<FileId>& file) {
  if (const auto input = file ? findInput(*file) : std::nullopt)
    throw requestError(ErrorCode::outputConflict, path, "would replace an input file",
                       (*input == path ? "" : " (" + input->string() + ")"),
                       "; choose another name");
}

Error duplicateError(const fs::path& path) {
  return requestError(ErrorCode::outputConflict, path,
                      "would be written twice; give each result its own name");
}

} // namespace

ContentDigest digestContent(std::string_view content) {
  Digest digest;
  digest.add(content);
  return {content.size(), digest.value()};
}

bool hasPlacedResults() {
  return anyPlaced;
}

struct Outputs::Result {
  fs::path path;
  std::optional<int> stream;           ///< see findStream
  std::string pending;                 ///< content of the stream
  fs::path target;                     ///< path of the file, links followed
  std::unique_ptr<TemporaryFile> file; ///< content written, not yet in place

  IsOwnFile isOwnFile; ///< empty: the user named the result
  std::optional<ContentDigest> written;

  std::optional<FileId> id() const {
    if (stream && *stream != namedPipe)
      return fileId(*stream);
    return fileId(stream ? path : target);
  }
  void requireOwnFile() const {
    std::error_code failed;
    // An empty file has no data to lose.
    if (isOwnFile && fs::exists(target, failed) && !fs::is_empty(target, failed) &&
        !isOwnFile(target))
      throw requestError(ErrorCode::foreignOutput, path, "exists and was not written by Fenestra");
  }
};

Outputs::Outputs() = default;

Outputs::~Outputs() = default;

void Outputs::add(const fs::path& path, const IsOwnFile& isOwnFile) {
  auto result = std::make_unique<Result>();
  result->path = path;
  result->stream = findStream(path);
  if (!result->stream) {
    result->target = resolveTarget(path);
    requireReplaceable(path, result->target);
    if (isTempName(result->target.filename().string(), tempFilePrefix))
      throw requestError(
          ErrorCode::outputConflict, path,
          "is a name for temporary files, which the next run removes; choose another name");
  }
  requireNotInput(path, result->id());
  const std::optional<FileId> id = result->id();
  if (!m_targets.insert(result->stream ? path : result->target).second ||
      (id && !m_files.insert(*id).second))
    throw duplicateError(path);
  if (!result->stream && m_folders.insert(result->target.parent_path()).second) {
    removeStaleTempFiles(result->target.parent_path(), tempFilePrefix, TempFileGuard::Kind::file);
    const TemporaryFile probe(result->target); // throws if none can be created
  }
  result->isOwnFile = isOwnFile;
  m_results[path] = std::move(result);
  m_results[path]->requireOwnFile();
}

void Outputs::checkInputs() const {
  for (const auto& [path, result] : m_results)
    requireNotInput(path, result->id());
}

void Outputs::unregisterInputs() const {
  for (const auto& [path, result] : m_results)
    if (const auto file = result->id())
      unregisterInput(*file);
}

void Outputs::write(const fs::path& path, std::string_view content) {
  Result& result = *m_results.at(path);
  result.written = digestContent(content);
  if (result.stream) {
    result.pending = content;
    return;
  }
  result.file = std::make_unique<TemporaryFile>(result.target);
  if (const auto file = result.file->id()) // inode numbers are reused; birth times may be unknown
    unregisterInput(*file);
  result.file->write(content);
}

std::optional<ContentDigest> Outputs::writtenDigest(const fs::path& path) const {
  const auto result = m_results.find(path);
  return result == m_results.end() ? std::nullopt : result->second->written;
}

void Outputs::place(const std::vector<Result*>& files, Durability durability) {
  std::set<fs::path> folders;
  for (const Result* result : files)
    folders.insert(result->target.parent_path());
  std::vector<Descriptor> locks = lockFolders(folders);
  const SignalBlocker blocker;
  std::size_t placed = 0;
  std::set<FileId> placedIds; // two names may be one file if the file system ignores case
  try {
    for (Result* result : files) {
      const std::optional<FileId> before = result->id();
      requireNotInput(result->path, before);
      if (before && placedIds.contains(*before))
        throw duplicateError(result->path);
      requireReplaceable(result->path, result->target);
      result->requireOwnFile();
      result->file->place();
      ++placed;
      if (const auto after = result->id())
        placedIds.insert(*after);
    }
  } catch (...) {
    while (placed > 0)
      files[--placed]->file->undoPlace();
    throw;
  }
  anyPlaced = anyPlaced || placed > 0;
  locks.clear();
  for (Result* result : files)
    result->file.reset();
  if (durability == Durability::synced)
    std::for_each(folders.begin(), folders.end(), syncFolder);
}

void Outputs::commit(Durability durability) {
  std::vector<Result*> files;
  for (const auto& [path, result] : m_results)
    if (result->file) {
      result->file->finish(durability);
      files.push_back(result.get());
    }
  place(files, durability);
  for (const auto& [path, result] : m_results)
    if (!result->pending.empty())
      sendContent(*result->stream, std::exchange(result->pending, {}), result->path);
}

} // namespace fenestra::core
