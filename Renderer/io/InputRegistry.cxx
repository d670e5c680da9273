#include "io/InputRegistry.h"

#include "base/Error.h"
#include "io/platform/SystemErrors.h"

#include <algorithm>
#include <atomic>
#include <map>
#include <mutex>
#include <utility>

namespace fenestra::core {

struct InputRegistry::Content {
  std::mutex mutex;
  std::map<FileId, std::filesystem::path> inputs;

  void addInput(const FileId& file, const std::filesystem::path& path) {
    const std::lock_guard lock(mutex);
    inputs.try_emplace(file, path);
  }
};

namespace {

std::atomic<InputRegistry::Content*> registry = nullptr; ///< null: there is none

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

/// True for names that system calls would truncate at a zero byte.
bool hasZeroByte(const std::filesystem::path& path) {
  return path.native().find('\0') != std::string::npos;
}

} // namespace

InputRegistry::InputRegistry() : m_content(std::make_unique<Content>()) {
  registry = m_content.get();
}

InputRegistry::~InputRegistry() {
  registry = nullptr;
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
  const std::optional<FileId> file = registry ? fileId(path) : std::nullopt;
  if (file)
    registry.load()->addInput(*file, path);
}

void registerInput(const std::filesystem::path& path) {
  const auto addFile = [](const std::filesystem::path& file) {
    if (const std::optional<FileId> id = fileId(file))
      registry.load()->addInput(*id, file);
  };
  if (!registry || hasZeroByte(path))
    return;
  std::error_code failed;
  const auto type = std::filesystem::status(path, failed).type();
  if (type == std::filesystem::file_type::regular)
    addFile(path);
  else if (type == std::filesystem::file_type::directory)
    for (std::filesystem::directory_iterator entry(path, failed), end; !failed && entry != end;
         entry.increment(failed))
      if (entry->is_regular_file(failed))
        addFile(entry->path());
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
  InputRegistry::Content* const content = registry;
  if (!content)
    return std::nullopt;
  const std::lock_guard lock(content->mutex);
  const auto found = content->inputs.find(file);
  return found == content->inputs.end() ? std::nullopt : std::optional(found->second);
}

void unregisterInput(const FileId& file) {
  if (InputRegistry::Content* const content = registry) {
    const std::lock_guard lock(content->mutex);
    content->inputs.erase(file);
  }
}

std::string lowercaseExtension(const std::filesystem::path& path) {
  return toLower(path.extension().string());
}

} // namespace fenestra::core
