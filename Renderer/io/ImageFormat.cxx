#include "io/ImageFormat.h"

#include <algorithm>
#include <cctype>
#include <map>
#include <string>

namespace fenestra {

std::optional<ImageFormat> imageFormat(const std::filesystem::path& path) {
  static const std::map<std::string, ImageFormat> formats = {{".exr", ImageFormat::exr},
                                                             {".nrrd", ImageFormat::nrrd},
                                                             {".png", ImageFormat::png},
                                                             {".tif", ImageFormat::tiff},
                                                             {".tiff", ImageFormat::tiff}};
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  const auto it = formats.find(extension);
  return it == formats.end() ? std::nullopt : std::optional(it->second);
}

} // namespace fenestra
