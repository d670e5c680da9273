#pragma once
// Copies rank 0's input files to the other ranks, which prepare the scene from them. Sending the
// results of its stages instead would require a second representation of each.

#include "io/platform/Folders.h"
#include "program/Options.h"
#include "ranks/Ranks.h"

namespace fenestra::core {

/// Sends files to all other ranks, which construct ReceivedFiles meanwhile. Throws Error (input).
void broadcastFiles(const std::vector<std::filesystem::path>& files, const Ranks& ranks);

/// Copies of rank 0's files in a temporary folder (TMPDIR) of this rank.
class ReceivedFiles {
public:
  /// Throws Error (output).
  explicit ReceivedFiles(const Ranks& ranks);

  /// This rank's copy of a file of rank 0, which need not exist.
  std::filesystem::path localPath(const std::filesystem::path& remotePath) const;
  /// `options` with rank 0's file names, relative to its working folder, replaced by those of the
  /// copies.
  OptionValues localizePaths(const OptionValues& options, std::span<const Option> known) const;

private:
  PrivateFolder m_folder;
  std::filesystem::path m_working; ///< rank 0's working folder
};

} // namespace fenestra::core
