#pragma once
// Images to write, and a folder for them.

#include "ErrorChecks.h"
#include "WriteResults.h"
#include "files/images/ImageReader.h"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include <unistd.h>

namespace fenestra::core::testing_images {
namespace fs = std::filesystem;

inline std::string readContent(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream content;
  content << file.rdbuf();
  return content.str();
}

inline void writeContent(const fs::path& path, const std::string& content) {
  fs::remove(path); // overwriting makes some file systems flush to the disk
  std::ofstream(path, std::ios::binary) << content;
}

/// Image with a gradient in every channel of a render.
inline Image makeTestImage(int width = 13, int height = 7) {
  Image image{width, height, {}, {{"seed", "7"}, {"command", "fenestra a.nrrd --size 13x7"}}};
  float start = 0.0f;
  for (const char* name :
       {"R", "G", "B", "Z", "clip.Z", "albedo.R", "albedo.G", "albedo.B", "normal.X", "normal.Y",
        "normal.Z", "error.R", "error.G", "error.B", "samples.N"}) {
    auto& plane = image.channels[name];
    for (int i = 0; i < width * height; ++i)
      plane.push_back(start + 0.01f * static_cast<float>(i));
    start += 0.1f;
  }
  image.channels["A"].assign(static_cast<std::size_t>(width * height), 1.0f);
  return image;
}

class ImageFiles : public ::testing::Test {
protected:
  void SetUp() override {
    const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
    m_folder = fs::path(::testing::TempDir()) /
               ("fenestra-" + std::to_string(::getpid()) + "-" + test->name());
    fs::create_directory(m_folder);
  }
  void TearDown() override { fs::remove_all(m_folder); }

  fs::path path(const std::string& name) const { return m_folder / name; }
  std::size_t fileCount() const {
    return static_cast<std::size_t>(
        std::distance(fs::directory_iterator(m_folder), fs::directory_iterator()));
  }
  fs::path save(const Image& image, const std::string& name, const ImagePlane& plane = {},
                const Display& display = {}) const {
    writeImage(image, plane, path(name), display);
    return path(name);
  }

  fs::path m_folder;
};

} // namespace fenestra::core::testing_images
