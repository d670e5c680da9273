#pragma once
// Names that must not outlive the process, and moments at which a signal must not end it.

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace fenestra {

/// Of files that are made beside results.
inline constexpr std::string_view temporaryFilePrefix = ".fenestra-";

/// `prefix`, twelve random digits and a checksum of them, like
/// ".fenestra-0123456789ab-89abcdef.tmp": what has such a name may be removed, so it must not be
/// anybody's by chance.
std::string temporaryName(std::string_view prefix);
/// The same, with digits that follow from `what`: one that processes find without telling each
/// other.
std::string temporaryNameOf(std::string_view prefix, std::string_view what);
bool isTemporaryName(std::string_view name, std::string_view prefix);

/// Calls `use` with each path of such a name in the folder, for whoever sweeps what others have
/// left: where the folder cannot be read, or memory fails, the rest stays to the next.
void forTemporaryNames(const std::filesystem::path& folder, std::string_view prefix,
                       const std::function<void(const std::filesystem::path&)>& use);

/// A temporary file or folder: removed with this object, or by the signal that ends the process.
class Leftover {
public:
  enum class Kind { file, folder };

  /// Lists `path`, which need not be there yet. Throws std::bad_alloc before anything is made.
  Leftover(const std::filesystem::path& path, Kind kind);
  /// Removes the name; a folder only where it is empty by then.
  ~Leftover();
  Leftover(const Leftover&) = delete;
  Leftover& operator=(const Leftover&) = delete;

  const std::filesystem::path& path() const;
  /// The name stays, whatever happens.
  void keep();

private:
  struct Entry;
  friend void removeLeftovers();
  friend std::vector<std::filesystem::path> remainingLeftovers();

  Entry* m_entry;
};

/// Removes every listed name: files, then folders from the inside out. Makes system calls alone, as
/// a signal handler must.
void removeLeftovers();

/// Names that could not be removed, for the user to do it.
std::vector<std::filesystem::path> remainingLeftovers();

/// Moment between two states of the disk, as between making a name and listing it. Nests.
class Uninterrupted {
public:
  Uninterrupted();
  ~Uninterrupted();
  Uninterrupted(const Uninterrupted&) = delete;
  Uninterrupted& operator=(const Uninterrupted&) = delete;
};

/// Calls `end`, which ends the process, now or as soon as no thread is Uninterrupted; returns in
/// the second case. For a signal handler.
void endWhenPossible(void (*end)());

} // namespace fenestra
