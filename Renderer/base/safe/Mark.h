#pragma once
// Sign that Fenestra wrote a file as it is: a mark with a checksum of the rest, so that what
// somebody has edited since is told from it.

#include <filesystem>
#include <string>
#include <string_view>

namespace fenestra {

/// What an encoder puts where its format has a place for text, once. seal() writes the checksum
/// (CRC-32, eight digits) in the place of the zeros; four bytes behind them are not in it, for PNG
/// has a checksum of its own there.
inline constexpr std::string_view unsealedMark = "Written by Fenestra 00000000";

/// `content` with its last unsealed mark sealed.
std::string sealed(std::string content);

/// Whether the file has a mark, among its last few, whose checksum is right. False where it cannot
/// be read. It may have any size: it is never in memory as a whole, and its time grows with that
/// alone.
bool bearsMark(const std::filesystem::path& path);

} // namespace fenestra
