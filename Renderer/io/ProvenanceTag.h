#pragma once
// Provenance tag: text in a file that says that Fenestra wrote it, with a checksum of the rest. A
// file that was edited since has no valid tag.

#include <filesystem>
#include <string>
#include <string_view>

namespace fenestra::core {

/// Placeholder that an encoder writes once, into a text field of its format. sealProvenanceTag()
/// replaces the zeros by the checksum (CRC-32, 8 digits) of all other bytes except the 4 after the
/// digits, where PNG has a checksum of its own.
inline constexpr std::string_view blankProvenanceTag = "Written by Fenestra 00000000";

/// Replaces the zeros of the last placeholder in `content`.
std::string sealProvenanceTag(std::string content);

/// True if one of the file's last 4 tags has the right checksum; Fenestra's files have their own
/// tag last, after those of files that they contain. False also if the file cannot be read, or is
/// larger than a quarter of the memory.
bool hasProvenanceTag(const std::filesystem::path& path);

} // namespace fenestra::core
