#include "io/Outputs.h"

#include "base/Error.h"
#include "io/Digest.h"
#include "io/InputRegistry.h"
#include "io/Locks.h"
#include "io/SystemErrors.h"
#include "io/TemporaryFile.h"

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <iostream>
#include <optional>
#include <set>
#include <utility>

#include <fcntl.h>

namespace fenestra::core {
namespace {

namespace fs = std::filesystem;

constexpr int namedPipe = -1; ///< stream that is opened when its content is sent

std::atomic<bool> anyPlaced = false;

/// File that writing to `path` would change; links are followed, dangling ones as well. The folder
/// is canonical, so that each file has one name. Throws Error (output).
fs::path resolveTarget(const fs::path& path) {
  constexpr int maxLinks = 40; // Linux's limit
  std::error_code failed;
  fs::path target = fs::absolute(path, failed);
  if (failed)
    throw writeError(path, failed.value());
  for (int links = 0; fs::is_symlink(target, failed) && links < maxLinks; ++links)
    target = target.parent_path() / fs::read_symlink(target);
  const fs::path folder = fs::canonical(target.parent_path(), failed);
  if (failed)
    throw writeError(path, failed.value());
  return folder / target.filename();
}

/// True if this process may not rename over the file: in a sticky folder, such as /tmp, only the
/// owners of the file and of the folder may (rename(2), EPERM).
bool isStickyProtected(const struct stat& file, const fs::path& folder) {
  struct stat status = {};
  const uid_t user = ::geteuid();
  return ::stat(folder.c_str(), &status) == 0 && (status.st_mode & S_ISVTX) != 0 && user != 0 &&
         user != file.st_uid && user != status.st_uid;
}

void requireReplaceable(const fs::path& path, const fs::path& target) {
  struct stat status = {};
  if (!target.has_filename())
    throw outputError(ErrorCode::notAFile, path, "is a folder; name a file");
  if (::lstat(target.c_str(), &status) != 0) {
    if (errno != ENOENT)
      throw writeError(path, errno);
    return;
  }
  if (!S_ISREG(status.st_mode))
    throw outputError(ErrorCode::notAFile, path, "is a folder or a device; name a file");
  if ((status.st_mode & 0222) == 0 || ::faccessat(AT_FDCWD, target.c_str(), W_OK, AT_EACCESS) != 0)
    throw outputError(path, "is write-protected; choose another name, or chmod u+w it");
  if (isStickyProtected(status, target.parent_path()))
    throw outputError(path, "belongs to another user, in a folder where only owners may replace "
                            "files; choose another name or folder");
}

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

void syncFolder(const fs::path& folder) {
  const Descriptor file(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  // A folder that may be written but not read cannot be synced.
  if (!(file.isOpen() ? ::fsync(*file) == 0 || errno == EINVAL : errno == EACCES))
    throw writeError(folder, errno);
}

/// N of /dev/fd/N and similar paths; nullopt: other paths.
std::optional<int> parseDescriptorNumber(const std::string& path) {
  if (path == "/dev/stdout")
    return STDOUT_FILENO;
  if (path == "/dev/stderr")
    return STDERR_FILENO;
  for (const std::string_view folder : {"/dev/fd/", "/proc/self/fd/"}) {
    const auto number =
        path.starts_with(folder) ? parseNumber<int>(path.substr(folder.size())) : std::nullopt;
    if (number && *number >= 0)
      return number;
  }
  return std::nullopt;
}

/// Descriptor of a result that is not a file: /dev/stdout, /dev/stderr, /dev/fd/N, /proc/self/fd/N,
/// or `namedPipe`; nullopt: other paths. Throws Error (output) if the descriptor is not open for
/// writing.
std::optional<int> findStream(const fs::path& path) {
  if (const auto number = parseDescriptorNumber(path.lexically_normal().string())) {
    const int flags = ::fcntl(*number, F_GETFL);
    if (flags < 0 || (flags & O_ACCMODE) == O_RDONLY)
      throw outputError(path, "is not open for writing; redirect it, as in 3>FILE");
    return number;
  }
  struct stat status = {};
  const bool isPipe = ::stat(path.c_str(), &status) == 0 && S_ISFIFO(status.st_mode);
  return isPipe ? std::optional(namedPipe) : std::nullopt;
}

/// Throws Error (output), also if no process reads the pipe.
void sendContent(int stream, const std::string& content, const fs::path& path) {
  if (stream != namedPipe) {
    std::cout.flush(); // earlier output comes first
    std::fflush(stdout);
    return writeAll(stream, content, path);
  }
  // Without O_NONBLOCK, open would block until a process reads the pipe.
  const Descriptor file(::open(path.c_str(), O_WRONLY | O_NONBLOCK | O_CLOEXEC));
  if (!file.isOpen())
    throw outputError(path, "pipe has no reader; start the reader first");
  ::fcntl(*file, F_SETFL, 0);
  writeAll(*file, content, path);
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

Outputs::~Outputs() {
  for (const auto& [path, result] : m_results)
    unregisterResult(result->target);
}

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
  const std::optional<FileId> parent = fileId(result->target.parent_path());
  if ((parent && !m_targets.emplace(*parent, result->target.filename().string()).second) ||
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
      registerResult(result->target);
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
