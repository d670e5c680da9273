#include "files/pictures/ImageFormat.h"

#include "base/safe/Inputs.h"

#include <map>
#include <string>

namespace fenestra {

std::optional<ImageFormat> imageFormat(const std::filesystem::path& path) {
  static const std::map<std::string, ImageFormat> formats = {{".exr", ImageFormat::exr},
                                                             {".nrrd", ImageFormat::nrrd},
                                                             {".png", ImageFormat::png},
                                                             {".tif", ImageFormat::tiff},
                                                             {".tiff", ImageFormat::tiff}};
  const auto it = formats.find(lowerExtension(path));
  return it == formats.end() ? std::nullopt : std::optional(it->second);
}

} // namespace fenestra
