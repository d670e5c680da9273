#pragma once
// Temporary files that are removed when the process ends, also by a signal; and sections of code
// that signals must not interrupt. The signal handlers are the program's: a program without them,
// which uses Fenestra as a library, leaves the files of a killed process to the next run.

#include <filesystem>
#include <list>
#include <string>
#include <string_view>
#include <vector>

namespace fenestra::core {

/// Prefix of temporary files beside results.
inline constexpr std::string_view tempFilePrefix = ".fenestra-";

/// Name of `prefix`, 12 random digits and a checksum, such as
/// ".fenestra-0123456789ab-89abcdef.tmp". Stale files with such names are removed; the checksum
/// protects a user's file of a similar name.
std::string makeTempName(std::string_view prefix);
/// Temporary name whose digits are a hash of `what`, and so the same in every process.
std::string makeHashedTempName(std::string_view prefix, std::string_view what);
bool isTempName(std::string_view name, std::string_view prefix);

/// Removes a temporary file or folder with this object, or when a signal ends the process.
class TempFileGuard {
public:
  enum class Kind { file, folder };

  /// Registers `path`, which need not exist yet. Throws std::bad_alloc, before the caller creates
  /// the file.
  TempFileGuard(const std::filesystem::path& path, Kind kind);
  /// Removes the file, or the folder if empty.
  ~TempFileGuard();
  TempFileGuard(const TempFileGuard&) = delete;
  TempFileGuard& operator=(const TempFileGuard&) = delete;

  const std::filesystem::path& path() const;
  /// Unregisters the name: the file stays.
  void release();

private:
  struct Entry;
  friend void removeAllTempFiles();
  friend std::vector<std::filesystem::path> remainingTempFiles();

  std::list<Entry>::iterator m_entry;
};

/// Removes temporary files or folders that killed runs of this user have left in `folder` and no
/// process has locked; folders only if accessible to this user alone. Stops silently if `folder`
/// cannot be read or memory runs out; a later run removes the rest.
void removeStaleTempFiles(const std::filesystem::path& folder, std::string_view prefix,
                          TempFileGuard::Kind kind);

/// Removes every registered name: files, then folders from the inside out. For a signal handler
/// that endWhenUnblocked calls, and for the end of a process without other threads.
void removeAllTempFiles();

/// Registered names that still exist, for a message to the user.
std::vector<std::filesystem::path> remainingTempFiles();

/// Delays endWhenUnblocked, for example from registering a name until its file is created. Nests.
/// Masks no signal, and waits only after endWhenUnblocked was called.
class SignalBlocker {
public:
  SignalBlocker();
  ~SignalBlocker();
  SignalBlocker(const SignalBlocker&) = delete;
  SignalBlocker& operator=(const SignalBlocker&) = delete;
};

/// Calls `end`, which ends the process: immediately, or, after this function has returned, as soon
/// as no thread has a SignalBlocker. For a signal handler.
void endWhenUnblocked(void (*end)());

} // namespace fenestra::core
