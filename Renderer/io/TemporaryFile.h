#pragma once
// Result being written: complete on the disk under a short name beside its target before it is
// renamed. For io/Outputs.

#include "io/Descriptor.h"
#include "io/InputRegistry.h"
#include "io/TempFiles.h"

#include <optional>
#include <string_view>

namespace fenestra {

enum class Durability { synced, none }; ///< synced: on the disk before a function returns

/// File with a temporary name (io/TempFiles), listed there and locked (flock): a later run
/// in the folder removes files that SIGKILL has left.
class TemporaryFile {
public:
  /// Makes an empty file, accessible to its owner alone, in the folder of `target`. Throws Error
  /// (output), which names `target`.
  explicit TemporaryFile(const std::filesystem::path& target);

  /// Appends. Throws Error (output), a full disk included.
  void write(std::string_view content);

  /// Sets mode, owner and access list as the file at `target` has them, or as a new file has; where
  /// owner or group cannot be set, nobody gains rights. Throws Error (output).
  void finish(Durability durability);

  /// Renames this file to `target`; an existing target takes the temporary name, and is removed
  /// with this object. Throws Error (output), and then has changed nothing.
  void place();
  /// Undoes place(), after another file of the group could not be placed.
  void undoPlace() noexcept;

private:
  enum class Placed { no, fresh, exchanged, linked };

  void open();
  void placeByLink();

  std::filesystem::path m_target;
  Descriptor m_file;
  Descriptor m_replaced; ///< the earlier file, locked while its name is temporary
  /// Names, removed before their locks are released; m_before: the earlier file (placeByLink).
  std::optional<TempFileGuard> m_name, m_before;
  Placed m_placed = Placed::no;
};

} // namespace fenestra
