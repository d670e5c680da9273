#include "io/Inputs.h"

#include "core/Error.h"
#include "io/SystemCalls.h"

#include <algorithm>
#include <cctype>
#include <map>
#include <mutex>

namespace fenestra {
namespace {

struct Ledger {
  std::mutex mutex;
  std::map<FileId, std::filesystem::path> files, results;
};

Ledger& ledger() {
  static Ledger ledger;
  return ledger;
}

void enter(const struct stat& status, const std::filesystem::path& path) {
  const std::lock_guard lock(ledger().mutex);
  ledger().files.try_emplace(FileId{status.st_dev, status.st_ino}, path);
}

bool isResult(const FileId& file) {
  const std::lock_guard lock(ledger().mutex);
  const auto found = ledger().results.find(file);
  return found != ledger().results.end() && fileId(found->second) == file;
}

thread_local std::filesystem::path confinement; ///< canonical; empty: anywhere

bool isWithin(const std::filesystem::path& path, const std::filesystem::path& folder) {
  std::error_code failed;
  const std::filesystem::path real = std::filesystem::canonical(path, failed);
  return !failed && std::mismatch(folder.begin(), folder.end(), real.begin(), real.end()).first ==
                        folder.end();
}

std::string megabytes(std::uint64_t bytes) {
  return std::to_string(bytes >> 20) + " MB";
}

} // namespace

std::optional<FileId> fileId(const std::filesystem::path& path) {
  struct stat status = {};
  if (::stat(path.c_str(), &status) != 0)
    return std::nullopt;
  return FileId{status.st_dev, status.st_ino};
}

void requireFile(const std::filesystem::path& path, const std::string& mend, std::uint64_t most) {
  // Before it is looked at: a name on an automount or a server would tell others of itself.
  if (!confinement.empty() && !isWithin(path, confinement))
    throw inputError(path.string(), "is outside the archive that names it; save the scene again");
  struct stat status = {};
  if (::stat(path.c_str(), &status) != 0) {
    if (errno == ENOENT || errno == ENOTDIR)
      throw inputError(path.string(), "there is no such file; check the name");
    throw readingError(path, errno, "check its permissions and those of its folder");
  }
  if (S_ISDIR(status.st_mode))
    throw inputError(path.string(), "is a folder; " + mend);
  if (!S_ISREG(status.st_mode))
    throw inputError(path.string(), "is not a file that can be read; " + mend);
  if (static_cast<std::uint64_t>(status.st_size) > most)
    throw inputError(path.string(), "has more than " + megabytes(most) + "; name a smaller file");
  if (isResult({status.st_dev, status.st_ino}))
    throw inputError(path.string(), "is a result of this command; name another file");
  enter(status, path);
}

void expectInput(const std::filesystem::path& path) {
  struct stat status = {};
  if (::stat(path.c_str(), &status) != 0)
    return;
  if (S_ISREG(status.st_mode))
    enter(status, path);
  std::error_code failed;
  if (S_ISDIR(status.st_mode))
    for (std::filesystem::directory_iterator entry(path, failed), end; !failed && entry != end;
         entry.increment(failed))
      if (entry->is_regular_file(failed))
        expectInput(entry->path());
}

InputsWithin::InputsWithin(const std::filesystem::path& folder) : m_before(confinement) {
  confinement = std::filesystem::canonical(folder);
}

InputsWithin::~InputsWithin() {
  confinement = std::move(m_before);
}

std::optional<std::filesystem::path> inputNamed(const FileId& file) {
  const std::lock_guard lock(ledger().mutex);
  const auto found = ledger().files.find(file);
  return found == ledger().files.end() ? std::nullopt : std::optional(found->second);
}

void forgetInput(const FileId& file) {
  const std::lock_guard lock(ledger().mutex);
  ledger().files.erase(file);
}

void enterResult(const std::filesystem::path& path, const std::optional<FileId>& before) {
  const std::lock_guard lock(ledger().mutex);
  if (before)
    ledger().results.erase(*before);
  if (const auto file = fileId(path))
    ledger().results[*file] = path;
}

std::string lowerExtension(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

} // namespace fenestra
