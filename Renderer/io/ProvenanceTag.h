#pragma once
// Mark that Fenestra wrote a file, with a checksum of the rest: a file edited since then has no
// valid mark.

#include <filesystem>
#include <string>
#include <string_view>

namespace fenestra {

/// Text that an encoder writes once, into a text field of its format. sealed() replaces the zeros
/// by the checksum (CRC-32, 8 digits) of all other bytes but the 4 after the digits, where PNG has
/// a checksum of its own.
inline constexpr std::string_view blankProvenanceTag = "Written by Fenestra 00000000";

/// `content` with its last unsealed mark sealed.
std::string sealProvenanceTag(std::string content);

/// True if one of the file's last 4 marks has the right checksum; false also where the file cannot
/// be read. Reads block by block: constant memory, time linear in the file's size.
bool hasProvenanceTag(const std::filesystem::path& path);

} // namespace fenestra
