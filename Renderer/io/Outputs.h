#pragma once
// Results of a command. They are declared before the long work, refused if they would overwrite a
// user's file, and put in place together when complete. Nothing else in Renderer writes results.
//
// Contents are complete and synced under temporary names before the first is renamed. Names are
// exchanged, so that a rename that fails restores the previous files. Encoders work in memory, so
// that a full disk is detected here alone. What the process has read is protected if there is an
// InputRegistry. Programs without a handler that calls endWhenUnblocked (io/platform/TempFiles.h)
// can be ended by a signal between two renames.

#include "io/InputRegistry.h"
#include "io/ProvenanceTag.h"
#include "io/platform/TemporaryFile.h"

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

namespace fenestra::core {

/// Size and digest (io/Digest.h) of a content, which identify a result.
struct ContentDigest {
  std::uint64_t bytes = 0, digest = 0;

  friend bool operator==(const ContentDigest&, const ContentDigest&) = default;
};
ContentDigest digestContent(std::string_view content);

/// True once this process has put a result in place, for its last message. Async-signal-safe.
bool hasPlacedResults();

class Outputs {
public:
  Outputs();
  ~Outputs();
  Outputs(const Outputs&) = delete;
  Outputs& operator=(const Outputs&) = delete;

  /// True if Fenestra wrote the existing file, which may then be replaced without asking.
  using IsOwnFile = std::function<bool(const std::filesystem::path&)>;

  /// Declares a result that the user has named, or, with `isOwnFile`, one that Fenestra names.
  /// Links are followed; /dev/stdout, /dev/fd/N and pipes are streams, written after all files.
  /// Throws Error: request if `path` is a registered input, another result, a temporary file's
  /// name, or a file that is neither Fenestra's own nor empty; output if `path` is a folder, a
  /// device or write-protected, or no file can be created in its folder.
  void add(const std::filesystem::path& path, const IsOwnFile& isOwnFile = {});

  /// Repeats add's check against the input registry, after more files were read. Throws Error
  /// (request).
  void checkInputs() const;
  /// Removes the results from the input registry, after a request that reads a result was refused.
  void unregisterInputs() const;

  /// Writes the complete content of a declared result to the disk, not yet in place. Callable from
  /// any thread. Throws Error (output), also if the disk is full.
  void write(const std::filesystem::path& path, std::string_view content);
  /// Digest of the content written last; nullopt: none, or not a declared result.
  std::optional<ContentDigest> writtenDigest(const std::filesystem::path& path) const;

  /// Puts all content written since the last commit in place, all or nothing: a failure restores
  /// the previous files. If two processes have the same results, one places all of its own before
  /// the other. No signal ends the process meanwhile. Throws Error: request if a result has become
  /// an input; output if a result cannot be placed.
  void commit(Durability durability = Durability::synced);

private:
  struct Result;

  void place(const std::vector<Result*>& files, Durability durability);

  std::map<std::filesystem::path, std::unique_ptr<Result>> m_results; ///< by the name given to add
  std::set<std::filesystem::path> m_targets; ///< of all results; the path of a stream
  std::set<FileId> m_files;                  ///< existing files of declared names
  std::set<std::filesystem::path> m_folders; ///< folders in which files can be created
};

} // namespace fenestra::core
