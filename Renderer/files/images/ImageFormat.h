#pragma once
// Image file formats.

#include "io/InputRegistry.h"

#include <map>

namespace fenestra::core {

enum class ImageFormat { exr, nrrd, png, tiff };

inline constexpr const char* imageExtensions = ".exr, .nrrd, .png or .tif";

/// Format by file extension, case-insensitive; nullopt: unknown.
inline std::optional<ImageFormat> findImageFormat(const std::filesystem::path& path) {
  static const std::map<std::string, ImageFormat> formats = {{".exr", ImageFormat::exr},
                                                             {".nrrd", ImageFormat::nrrd},
                                                             {".png", ImageFormat::png},
                                                             {".tif", ImageFormat::tiff},
                                                             {".tiff", ImageFormat::tiff}};
  const auto it = formats.find(lowercaseExtension(path));
  return it == formats.end() ? std::nullopt : std::optional(it->second);
}

/// True if the extension is that of a display image (PNG or TIFF).
inline bool isDisplayFile(const std::filesystem::path& path) {
  const auto format = findImageFormat(path);
  return format == ImageFormat::png || format == ImageFormat::tiff;
}

} // namespace fenestra::core
