#include "io/InputRegistry.h"

#include "base/Error.h"
#include "io/platform/SystemErrors.h"

#include <algorithm>
#include <map>
#include <mutex>
#include <utility>

namespace fenestra::core {

namespace {

std::mutex mutex;                                          ///< of `inputs` and its content
std::map<FileId, std::filesystem::path>* inputs = nullptr; ///< of the registry; null: none

/// Canonical folder to which this thread's reads are confined; null: not confined. A pointer, since
/// a thread_local object with a destructor ends the process if memory runs out.
thread_local const std::filesystem::path* confinement = nullptr;

bool isWithin(const std::filesystem::path& path, const std::filesystem::path& folder) {
  std::error_code failed;
  const std::filesystem::path real = std::filesystem::canonical(path, failed);
  return !failed && std::mismatch(folder.begin(), folder.end(), real.begin(), real.end()).first ==
                        folder.end();
}

std::filesystem::file_type getFileType(const std::filesystem::path& path) {
  std::error_code failed;
  const std::filesystem::file_type type = std::filesystem::status(path, failed).type();
  if (type == std::filesystem::file_type::none)
    throw readError(path, failed.value(), "check the permissions of its folder");
  return type;
}

void addInput(const std::filesystem::path& path) {
  const std::lock_guard lock(mutex);
  if (const auto file = inputs ? fileId(path) : std::nullopt)
    inputs->try_emplace(*file, path);
}

/// True for names that system calls would truncate at a zero byte.
bool hasZeroByte(const std::filesystem::path& path) {
  return path.native().find('\0') != std::string::npos;
}

} // namespace

InputRegistry::InputRegistry() {
  const std::lock_guard lock(mutex);
  inputs = &m_inputs;
}

InputRegistry::~InputRegistry() {
  const std::lock_guard lock(mutex);
  inputs = nullptr;
}

bool fileExists(const std::filesystem::path& path) {
  return getFileType(path) != std::filesystem::file_type::not_found;
}

bool isFolder(const std::filesystem::path& path) {
  return getFileType(path) == std::filesystem::file_type::directory;
}

FolderContent listFolder(const std::filesystem::path& folder) {
  FolderContent content;
  std::error_code failed;
  for (std::filesystem::directory_iterator entry(folder, failed), end; !failed && entry != end;
       entry.increment(failed))
    if (std::error_code unknown; entry->is_regular_file(unknown))
      content.files.push_back(entry->path());
    else if (entry->is_directory(unknown))
      content.folders.push_back(entry->path());
  if (failed)
    throw inputError(ErrorCode::unreadableFile, folder, "folder cannot be read: ", failed.message(),
                     "; ", readHint(failed.value(), "check its name and its permissions"));
  std::ranges::sort(content.files);
  std::ranges::sort(content.folders);
  return content;
}

void requireFile(const std::filesystem::path& path, const std::string& hint,
                 std::uint64_t maxBytes) {
  if (hasZeroByte(path))
    throw inputError(path.c_str(),
                     "is followed by a zero byte in the file that names it; save that file again");
  // Checked before any access, which could mount a file system or reveal the read to a server.
  if (confinement && !isWithin(path, *confinement))
    throw inputError(ErrorCode::outsideArchive, path,
                     "is not inside the archive that refers to it; save the scene again");
  const FileStatus status = readFileStatus(path);
  if (status.error == ENOENT || status.error == ENOTDIR)
    throw inputError(ErrorCode::missingFile, path, "no such file; check the name");
  if (status.error != 0)
    throw readError(path, status.error, "check its permissions and those of its folder");
  if (status.isFolder)
    throw inputError(ErrorCode::notAFile, path, "is a folder; ", hint);
  if (!status.isRegular)
    throw inputError(ErrorCode::notAFile, path, "is not a regular file; ", hint);
  if (status.bytes > maxBytes)
    throw inputError(ErrorCode::limitExceeded, path, "is larger than ", maxBytes >> 20,
                     " MB; use a smaller file");
  if (const int error = findReadError(path); error != 0)
    throw readError(path, error, "check its permissions");
  addInput(path);
}

void registerInput(const std::filesystem::path& path) {
  if (hasZeroByte(path))
    return;
  std::error_code failed;
  const auto type = std::filesystem::status(path, failed).type();
  if (type == std::filesystem::file_type::regular)
    addInput(path);
  else if (type == std::filesystem::file_type::directory)
    for (std::filesystem::directory_iterator entry(path, failed), end; !failed && entry != end;
         entry.increment(failed))
      if (entry->is_regular_file(failed))
        addInput(entry->path());
}

InputConfinement::InputConfinement(const std::optional<std::filesystem::path>& folder) {
  if (folder)
    m_folder = std::filesystem::canonical(*folder);
  m_previous = std::exchange(confinement, m_folder ? &*m_folder : nullptr);
}

InputConfinement::~InputConfinement() {
  confinement = m_previous;
}

std::optional<std::filesystem::path> findInput(const FileId& file) {
  const std::lock_guard lock(mutex);
  return inputs && inputs->contains(file) ? std::optional(inputs->at(file)) : std::nullopt;
}

void unregisterInput(const FileId& file) {
  const std::lock_guard lock(mutex);
  if (inputs)
    inputs->erase(file);
}

std::string lowercaseExtension(const std::filesystem::path& path) {
  return toLower(path.extension().string());
}

} // namespace fenestra::core
