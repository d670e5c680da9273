#pragma once
// Formats of picture files.

#include <filesystem>
#include <optional>

namespace fenestra {

enum class ImageFormat { exr, nrrd, png, tiff };

inline constexpr const char* imageExtensions = ".exr, .nrrd, .png or .tif";

/// Format by extension, in either case; nullopt: unknown.
std::optional<ImageFormat> imageFormat(const std::filesystem::path& path);

} // namespace fenestra
