#pragma once
// Results written in one call: declared, written and committed.

#include "files/images/ImageWriter.h"
#include "io/InputRegistry.h"
#include "io/Outputs.h"

namespace fenestra::core {

/// Removes the path from the input registry, so that tests may overwrite files that they have read.
inline void forgetIfRead(const std::filesystem::path& path) {
  if (const auto file = fileId(path))
    unregisterInput(*file);
}

inline void writeFile(const std::filesystem::path& path, std::string_view content) {
  forgetIfRead(path);
  Outputs outputs;
  outputs.add(path);
  outputs.write(path, content);
  outputs.commit();
}

inline void writeImage(const Image& image, const ImagePlane& plane,
                       const std::filesystem::path& path, const Display& display = {}) {
  for (const std::filesystem::path& file : listImageFiles(path))
    forgetIfRead(file);
  Outputs outputs;
  declareImage(path, outputs);
  writeImage(image, plane, path, outputs, display);
  outputs.commit();
}

} // namespace fenestra::core
