#pragma once
// Temporary names, removed when the process ends, by a signal as well; and sections of code that no
// signal may end the process in.

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace fenestra {

/// Prefix of files that are made beside results.
inline constexpr std::string_view tempFilePrefix = ".fenestra-";

/// Name of `prefix`, 12 random digits and a checksum, like ".fenestra-0123456789ab-89abcdef.tmp".
/// Files with such names are removed; the checksum keeps a user's file from having one by chance.
std::string makeTempName(std::string_view prefix);
/// Temporary name whose digits are a hash of `what`, and so the same in every process.
std::string hashTempName(std::string_view prefix, std::string_view what);
bool isTempName(std::string_view name, std::string_view prefix);

/// A temporary file or folder: removed with this object, or by the signal that ends the process.
class TempFileGuard {
public:
  enum class Kind { file, folder };

  /// Lists `path`, which need not exist yet. Throws std::bad_alloc, before the caller makes the
  /// file.
  TempFileGuard(const std::filesystem::path& path, Kind kind);
  /// Removes the file, or the folder if empty.
  ~TempFileGuard();
  TempFileGuard(const TempFileGuard&) = delete;
  TempFileGuard& operator=(const TempFileGuard&) = delete;

  const std::filesystem::path& path() const;
  /// Unlists the name: the file stays.
  void release();

private:
  struct Entry;
  friend void removeAllTempFiles();
  friend std::vector<std::filesystem::path> remainingTempFiles();

  Entry* m_entry;
};

/// Removes what killed runs of this user have left in `folder`: files, or folders accessible to
/// this user alone, that have temporary names and that no process has locked. Stops silently where
/// the folder cannot be read or memory fails: a later run handles the rest.
void removeStaleTempFiles(const std::filesystem::path& folder, std::string_view prefix,
                          TempFileGuard::Kind kind);

/// Removes every listed name: files, then folders from the inside out. Async-signal-safe: system
/// calls only.
void removeAllTempFiles();

/// Listed names that still exist, for a message to the user.
std::vector<std::filesystem::path> remainingTempFiles();

/// Section in which no signal may end the process, as from listing a name to making its file.
/// Nests.
class SignalBlocker {
public:
  SignalBlocker();
  ~SignalBlocker();
  SignalBlocker(const SignalBlocker&) = delete;
  SignalBlocker& operator=(const SignalBlocker&) = delete;
};

/// Calls `end`, which ends the process: at once, or, after this function has returned, as soon as
/// no thread is Uninterrupted. For a signal handler.
void endWhenUnblocked(void (*end)());

} // namespace fenestra
