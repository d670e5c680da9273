#pragma once
// The header of a NRRD, read before ITK's reader trusts it. For io's own sources.

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace fenestra {

struct NrrdHeaderText {
  /// By their keys in lower case and without blanks: of names with and without, teem takes both.
  std::map<std::string, std::string> fields;
  std::vector<std::string> files; ///< where the data file is a LIST
  std::uint64_t end = 0;          ///< byte after the header
};

/// Throws Error (input) where it is none, states what ITK's reader is known not to survive, or a
/// geometry that it would replace by its own.
NrrdHeaderText readNrrdHeader(const std::filesystem::path& path);

/// Whether it says how far voxels lie apart; otherwise ITK takes them to be 1 mm.
bool saysSpacing(const NrrdHeaderText& header);

/// Throws Error (input) where teem could not repeat the path in a message.
void checkNrrdPath(const std::filesystem::path& path);

/// Throws Error (input) where samples that are written as text, from byte `offset` of the file on,
/// hold a number that teem has no room for. `header` is named in the message.
void checkNrrdNumbers(const std::filesystem::path& file, std::uint64_t offset,
                      const std::filesystem::path& header);

} // namespace fenestra
