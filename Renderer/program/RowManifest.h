#pragma once
// Files and manifest of one row of a batch.

#include "io/platform/Folders.h"
#include "io/platform/Locks.h"
#include "program/BatchTable.h"
#include "program/Manifest.h"

namespace fenestra::core {

/// Result of a row.
struct RowOutcome {
  enum class State { missing, done, failed, stopped };

  State state = State::missing;
  int status = 0;         ///< exit status; 128 + number of the signal that ended the process
  double seconds = 0.0;   ///< wall time of its process
  std::string error = {}; ///< error message of a failed row
};

/// Folder, files and manifest of a row. A lock, one per row, excludes other batches during the
/// object's life, so that several machines can share a folder. An unfinished row also has a
/// checkpoint file, from which it resumes.
class RowManifest {
public:
  /// Creates the folder and reads an existing manifest; with `restart`, ignores finished work.
  /// `formats`: image extensions in addition to .png. Throws Error: usage if another process is
  /// rendering this row, or if an existing file differs from the manifest; input for a damaged
  /// manifest; output.
  RowManifest(const BatchRow& row, const std::filesystem::path& folder,
              const std::vector<std::string>& formats, bool restart);

  /// Outcome of an earlier, successful run with the same options and inputs; nullopt: none.
  const std::optional<RowOutcome>& finished() const { return m_finished; }
  /// Arguments of the process that renders the row, with its number of threads.
  std::vector<std::string> arguments(int threads) const;

  /// Writes the manifest, before the row is rendered, and removes a checkpoint file of other
  /// options. Throws Error (output).
  void begin();
  /// True if the row's process may have rejected its checkpoint file (damaged, or files or machine
  /// changed). Then removes that file; the row has to start over. Throws Error (output).
  bool discardCheckpoint(const RowOutcome& outcome);
  /// Writes the outcome to the manifest; for a finished row also files and inputs. Throws Error.
  void finish(const RowOutcome& outcome);

private:
  void read(bool restart);
  /// Existing files of the row.
  std::vector<std::filesystem::path> files() const;
  /// Throws Error (output).
  void removeCheckpoint() const;

  const BatchRow& m_row;
  std::filesystem::path m_folder; ///< of the row
  CreatedFolders m_made;
  std::vector<std::filesystem::path> m_images;
  std::filesystem::path m_checkpoint;
  bool m_isResumed = false; ///< from the checkpoint file
  NameLock m_lock;
  Manifest m_manifest;
  Outputs m_outputs;
  std::optional<RowOutcome> m_finished;
};

/// Files in the row's folder: NAME.png, and its statistics.
std::filesystem::path rowImagePath(const BatchRow& row, const std::filesystem::path& folder);
std::filesystem::path rowStatsPath(const BatchRow& row, const std::filesystem::path& folder);

} // namespace fenestra::core
