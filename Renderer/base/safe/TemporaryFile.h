#pragma once
// A result in the making: complete on the disk under a short name beside its place before it takes
// that. For base/safe/Outputs.

#include "base/safe/Inputs.h"
#include "base/safe/Leftovers.h"

#include <optional>
#include <string_view>

namespace fenestra {

/// Its name is a temporary one (base/safe/Leftovers), listed there and locked (flock): a later run
/// in the folder removes those that SIGKILL has left.
class TemporaryFile {
public:
  /// Empty, for its owner alone, in the folder of `target`, for which errors are told. Throws Error
  /// (output).
  explicit TemporaryFile(const std::filesystem::path& target);
  ~TemporaryFile();
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

  /// Appends. Throws Error (output), a full disk included.
  void write(std::string_view content);

  enum class Sync { disk, none };
  /// Gives it the mode and owner of the file at `target`, else what a new file has; where the owner
  /// or group cannot be set, others get no more rights than they had. Then syncs. Throws Error
  /// (output).
  void finish(Sync sync);

  /// Takes the name `target`; the file that had it, if any, gets this one's, and goes with it.
  /// Throws Error (output), and nothing has changed then.
  void place();
  /// Undoes place(), after another file of the group could not be placed.
  void takeBack() noexcept;

private:
  enum class Placed { no, fresh, exchanged, linked };

  void open();
  void placeByLink();
  bool isPlaced() const;

  std::filesystem::path m_target;
  std::optional<Leftover> m_name, m_before; ///< the second where the disk cannot exchange names
  int m_file = -1;
  int m_replaced = -1; ///< the file before, locked while it bears a temporary name; -1: none
  Placed m_placed = Placed::no;
};

/// Removes this user's temporary files in `folder` that no process has locked.
void removeAbandonedFiles(const std::filesystem::path& folder);

/// Throws Error (output) where no file can be made in the folder of `target` now.
void requireRoomFor(const std::filesystem::path& target);

} // namespace fenestra
