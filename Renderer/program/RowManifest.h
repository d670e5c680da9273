#pragma once
// Files of a study's row, and what their record tells of them.

#include "io/Folders.h"
#include "io/Locks.h"
#include "program/BatchTable.h"
#include "program/Manifest.h"

namespace fenestra {

/// End of a row.
struct RowOutcome {
  enum class State { missing, done, failed, stopped };

  State state = State::missing;
  int status = 0;         ///< exit status; 128 and a signal's number where one ended the process
  double seconds = 0.0;   ///< wall time of its process
  std::string error = {}; ///< error line of a row that failed
};

/// Folder, files and record of a row, held against other studies of these names during the
/// object's life. Until the row is done its film lies there, too, from which a row that was
/// interrupted goes on.
class RowManifest {
public:
  /// Makes the folder. Reads the record of the row, if any; with `restart`, nothing counts as
  /// finished. `formats`: extensions of pictures beside .png. Throws Error: usage if another
  /// process makes this row, or if a file is there that is not as recorded; input if the record is
  /// damaged; output.
  RowManifest(const BatchRow& row, const std::filesystem::path& folder,
              const std::vector<std::string>& formats, bool restart);

  /// Outcome of an earlier run with the same flags and inputs that was done; nullopt: none.
  const std::optional<RowOutcome>& finished() const { return m_finished; }
  /// Arguments of the process that makes the row, with its share of threads.
  std::vector<std::string> arguments(int threads) const;

  /// Puts the record in place, before the row is made, and removes a film of other flags. Throws
  /// Error (output).
  void begin();
  /// True if the film may be why the row's process refused to begin (files or machine have
  /// changed, or the film is damaged): it is removed, and the row has to be made from nothing.
  /// Throws Error (output).
  bool discardCheckpoint(const RowOutcome& outcome);
  /// Records what came of the row; of one that is done, files and inputs. Throws Error.
  void finish(const RowOutcome& outcome);

private:
  void read(bool restart);
  /// Files that the row has.
  std::vector<std::filesystem::path> files() const;
  /// Throws Error (output).
  void removeCheckpoint() const;

  const BatchRow& m_row;
  std::filesystem::path m_folder; ///< of the row
  CreatedFolders m_made;
  std::vector<std::filesystem::path> m_images;
  std::filesystem::path m_checkpoint;
  bool m_isResumed = false; ///< from the film
  NameLock m_lock;
  Manifest m_manifest;
  Outputs m_outputs;
  std::optional<RowOutcome> m_finished;
};

/// Files of a row in its folder: NAME.png, and its statistics.
std::filesystem::path rowImagePath(const BatchRow& row, const std::filesystem::path& folder);
std::filesystem::path rowStatsPath(const BatchRow& row, const std::filesystem::path& folder);

} // namespace fenestra
