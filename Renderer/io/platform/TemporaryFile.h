#pragma once
// Result being written: complete on the disk under a short name beside its target before it is
// renamed. For io/Outputs.

#include "io/platform/Descriptor.h"
#include "io/platform/FileStatus.h"
#include "io/platform/TempFiles.h"

#include <optional>
#include <string_view>

namespace fenestra::core {

enum class Durability { synced, none }; ///< synced: on the disk before the function returns

/// File with a temporary name, registered in io/TempFiles and locked (flock): a later run in the
/// folder removes such files after SIGKILL.
class TemporaryFile {
public:
  /// Creates an empty file in the folder of `target`, accessible to its owner alone if `target`
  /// exists. Throws Error (output), which names `target`.
  explicit TemporaryFile(const std::filesystem::path& target);

  std::optional<FileId> id() const { return fileId(*m_file); }

  /// Appends. Throws Error (output), also if the disk is full.
  void write(std::string_view content);

  /// Sets mode, owner and access control list to those of the file at `target`, if any. If owner or
  /// group cannot be set, no user gains rights. Throws Error (output).
  void finish(Durability durability);

  /// Renames this file to `target`. An existing target gets the temporary name, and is removed with
  /// this object. Throws Error (output) without having changed anything.
  void place();
  /// Undoes place(), after another file of the group could not be placed.
  void undoPlace() noexcept;

private:
  enum class Placed { no, fresh, exchanged, linked };

  void open();
  void placeByLink();

  std::filesystem::path m_target;
  Descriptor m_file;
  Descriptor m_replaced; ///< the previous file, locked while its name is temporary
  /// Names, removed before their locks are released; m_before: the previous file (placeByLink).
  std::optional<TempFileGuard> m_name, m_before;
  Placed m_placed = Placed::no;
};

} // namespace fenestra::core
