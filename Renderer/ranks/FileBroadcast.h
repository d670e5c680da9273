#pragma once
// Input files, which rank 0 has read, as files of the other ranks' own.

#include "io/Folders.h"
#include "program/Options.h"
#include "ranks/Ranks.h"

namespace fenestra {

/// Gives files to all other ranks, which call ReceivedFiles(ranks) meanwhile. Throws Error (input).
void broadcastFiles(const std::vector<std::filesystem::path>& files, Ranks& ranks);

/// Files of rank 0, in a temporary folder (TMPDIR) of this rank.
class ReceivedFiles {
public:
  /// Throws Error (output).
  explicit ReceivedFiles(Ranks& ranks);

  /// Flags with those names of files, relative to rank 0's working folder, that are here in place
  /// of the ones that rank 0 was given.
  OptionValues localizePaths(const OptionValues& options, std::span<const Flag> known) const;

private:
  std::filesystem::path localPath(const std::filesystem::path& remotePath) const;

  PrivateFolder m_folder;
  std::filesystem::path m_working; ///< rank 0's
};

} // namespace fenestra
