#pragma once
// NRRD header, validated before ITK's reader opens the file.

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace fenestra::core {

struct NrrdHeaderText {
  /// Values by key; keys in lower case without blanks (teem accepts "axis mins" and "axismins").
  std::map<std::string, std::string> fields;
  std::vector<std::string> files; ///< data files, where "data file" is a LIST
  std::uint64_t end = 0;          ///< offset of the byte after the header
};

/// Throws Error (input) if the file is not NRRD, for values known to crash ITK's reader, and for a
/// geometry that ITK would silently replace.
NrrdHeaderText readNrrdHeader(const std::filesystem::path& path);

/// Vectors in parentheses, one per axis; empty ones for "none". nullopt: a malformed vector.
std::optional<std::vector<std::vector<double>>> parseNrrdVectors(std::string_view text);

/// The axis of time in a header of four axes: of kind "time", or of no known kind and without a
/// direction in space. nullopt: none, several, or components (a list, a vector).
std::optional<std::size_t> findNrrdFrameAxis(const std::map<std::string, std::string>& fields);

/// True if the header states the voxel spacing; otherwise ITK assumes 1 mm.
bool hasNrrdSpacing(const NrrdHeaderText& header);

/// Throws Error (input) if the path may exceed teem's message buffer.
void checkNrrdPath(const std::filesystem::path& path);

/// Throws Error (input) if samples written as text, from byte `offset` of `file` on, contain a
/// number longer than teem's buffer. The message names `header`.
void checkNrrdNumbers(const std::filesystem::path& file, std::uint64_t offset,
                      const std::filesystem::path& header);

} // namespace fenestra::core
