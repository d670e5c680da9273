#pragma once
// Results of a command: declared before the long work, refused where they would cost the user a
// file, put in place together when complete. Nothing else in Renderer writes results.

#include "io/InputRegistry.h"
#include "io/ProvenanceTag.h"
#include "io/TemporaryFile.h"

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

/// Size and digest (Digest.h) of a content, which identify a result.
struct ContentDigest {
  std::uint64_t bytes = 0, digest = 0;

  friend bool operator==(const ContentDigest&, const ContentDigest&) = default;
};
ContentDigest digestContent(std::string_view content);

/// True once this process has put a result in place. Async-signal-safe.
bool hasPlacedResults();

class Outputs {
public:
  Outputs();
  ~Outputs();
  Outputs(const Outputs&) = delete;
  Outputs& operator=(const Outputs&) = delete;

  /// True if Fenestra wrote the existing file, which may then be replaced unasked.
  using IsOwnFile = std::function<bool(const std::filesystem::path&)>;

  /// Declares a result that the user has named, or, with `isOurs`, one that Fenestra names. Links
  /// are followed; /dev/stdout, /dev/fd/N and pipes are streams, written after all files. Throws
  /// Error: usage where `path` is a file that was read (io/InputRegistry), another result or a
  /// temporary file's name; output where `path` is a folder, a device or write-protected, or no
  /// file can be made in its folder; usage where `path` is a file that is neither ours nor empty.
  void add(const std::filesystem::path& path, const IsOwnFile& isOwnFile = {});

  /// Repeats add's check against the ledger of inputs, after more files were read. Throws Error
  /// (usage).
  void checkInputs() const;
  /// Removes the results from the ledger of inputs, after a request that reads a result was
  /// refused.
  void forgetInputs() const;

  /// Writes the whole content of a declared result to the disk, not yet in place. Callable from any
  /// thread. Throws Error (output), a full disk included.
  void write(const std::filesystem::path& path, std::string_view content);
  /// State of the content written last; nullopt: none, or no declared result.
  std::optional<ContentDigest> writtenDigest(const std::filesystem::path& path) const;

  /// Puts all content written since the last commit in place, all or nothing: after a failure the
  /// results placed before are taken back. Two processes with the same results place theirs one
  /// after the other. No signal ends the process meanwhile. Throws Error: usage where a result
  /// became an input since; output.
  void commit(Durability durability = Durability::synced);

private:
  struct Result;

  void place(const std::vector<Result*>& files, Durability durability);

  std::map<std::filesystem::path, std::unique_ptr<Result>> m_results; ///< by the name given to add
  std::set<std::pair<FileId, std::string>> m_targets; ///< folder and name of all results
  std::set<FileId> m_files;                           ///< existing files of declared names
  std::set<std::filesystem::path> m_folders;          ///< folders in which a file can be made
};

} // namespace fenestra
