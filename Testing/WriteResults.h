#pragma once
// Results written in one call: declared, written and committed.

#include "files/images/ImageWriter.h"
#include "io/Outputs.h"

namespace fenestra::core {

inline void writeFile(const std::filesystem::path& path, std::string_view content) {
  Outputs outputs;
  outputs.add(path);
  outputs.write(path, content);
  outputs.commit();
}

inline void writeImage(const Image& image, const ImagePlane& plane,
                       const std::filesystem::path& path, const Display& display = {}) {
  Outputs outputs;
  declareImage(path, outputs);
  writeImage(image, plane, path, outputs, display);
  outputs.commit();
}

} // namespace fenestra::core
