#pragma once
// Which picture files there are.

#include <filesystem>
#include <optional>

namespace fenestra {

enum class ImageFormat { exr, nrrd, png, tiff };

inline constexpr const char* imageExtensions = ".exr, .nrrd, .png or .tif";

/// By extension, in either case; nothing where it is unknown.
std::optional<ImageFormat> imageFormat(const std::filesystem::path& path);

} // namespace fenestra
