#pragma once
// What a command writes: declared before the long work, refused where that would cost the user a
// file, and put in place together when it is complete. Nothing else in Renderer writes results.

#include "base/safe/Inputs.h"
#include "base/safe/Mark.h"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace fenestra {

class TemporaryFile;

/// By which a file is told from another.
struct ContentState {
  std::uint64_t bytes = 0, digest = 0;

  friend bool operator==(const ContentState&, const ContentState&) = default;
};
ContentState stateOf(std::string_view content);

/// Whether this process has put a result in place. For signal handlers, too.
bool resultsWerePlaced();

class Outputs {
public:
  Outputs();
  ~Outputs();
  Outputs(const Outputs&) = delete;
  Outputs& operator=(const Outputs&) = delete;

  /// Declares a result that the user has named. Links are followed; /dev/stdout, /dev/fd/N and
  /// pipes are streams, written after all files. Throws Error: usage where it is a file that was
  /// read (base/safe/Inputs) or another result, or has a temporary file's name; output where it is
  /// a folder, a device or write-protected, or no file can be made in its folder.
  void add(const std::filesystem::path& path);

  /// Says whether an existing file is Fenestra's work, and so may be replaced unasked.
  using IsOurs = std::function<bool(const std::filesystem::path&)>;
  /// The same for a name that the user has not given. Throws Error (usage) also where a file is
  /// there that is neither ours nor empty.
  void addUnnamed(const std::filesystem::path& path, const IsOurs& isOurs = bearsMark);

  /// Asks the ledger of inputs again, after more files were read. Throws Error (usage).
  void checkInputs() const;
  /// Takes results out of that ledger, after a request that reads one of them was refused.
  void forgetRefused() const;

  /// The whole content of a declared result, complete on the disk but not in place. From any
  /// thread. Throws Error (output), a full disk included.
  void write(const std::filesystem::path& path, std::string_view content);
  /// Of what was written last; empty where nothing was.
  std::optional<ContentState> written(const std::filesystem::path& path) const;

  enum class Durability { synced, none };
  /// Puts everything in place that was written since the last commit, all or nothing: a result that
  /// cannot take its name takes the earlier ones back, and of two processes with the same results
  /// one places all of its own after the other. No signal ends the process in between.
  /// Throws Error: usage where a result became an input meanwhile; output.
  void commit(Durability durability = Durability::synced);

private:
  struct Result;

  Result& declare(const std::filesystem::path& path);
  void place(const std::vector<Result*>& files, Durability durability);

  std::map<std::filesystem::path, std::unique_ptr<Result>>
      m_results;                                      ///< by the name that was given
  std::set<std::pair<FileId, std::string>> m_targets; ///< folder and name of all results
  std::set<FileId> m_files;                           ///< that were there when they were declared
  std::set<std::filesystem::path> m_folders;          ///< in which a file can be made
};

} // namespace fenestra
