#pragma once
// Slicer scenes for tests: a folder with a small volume and .mrml files.

#include "files/slicer/MrmlScene.h"

#include "MedicalFiles.h"

#include <zip.h>

namespace fenestra::core {

/// A folder for scenes with ct.nrrd (3x4x2 int16, LPS origin 10,20,30 and spacing 1,2,3).
class SceneFolder : public TemporaryFolder {
public:
  SceneFolder() {
    std::vector<std::int16_t> voxels(24);
    for (std::size_t i = 0; i < voxels.size(); ++i)
      voxels[i] = static_cast<std::int16_t>(10 * i);
    FileGeometry geometry;
    geometry.origin = {10, 20, 30};
    geometry.spacing = {1, 2, 3};
    writeFile(*this / "ct.nrrd", voxels, geometry);
  }

  std::filesystem::path writeScene(const std::string& nodes,
                                   const std::string& name = "scene.mrml") const {
    return write(name, "<?xml version=\"1.0\"?>\n<MRML version=\"Slicer 5.6.2 32448\">" + nodes +
                           "</MRML>");
  }

  MrmlScene makeScene(const std::string& nodes) const { return MrmlScene(writeScene(nodes)); }
};

inline const std::string volumeNode = R"(
<VolumeArchetypeStorage id="store1" name="s" fileName="ct.nrrd"/>
<Volume id="vol1" name="CT" references="storage:store1;" spacing="9 9 9" origin="7 7 7"
  ijkToRASDirections="0 1 0 1 0 0 0 0 1"/>)";

/// Writes a zip archive with these files; names are not changed.
inline void writeArchive(const std::filesystem::path& path,
                         const std::map<std::string, std::string>& files) {
  int failure = 0;
  zip_t* archive = zip_open(path.c_str(), ZIP_CREATE | ZIP_TRUNCATE, &failure);
  ASSERT_TRUE(archive);
  for (const auto& [name, content] : files) {
    zip_source_t* source = zip_source_buffer(archive, content.data(), content.size(), 0);
    ASSERT_GE(zip_file_add(archive, name.c_str(), source, 0), 0) << name;
  }
  ASSERT_EQ(zip_close(archive), 0); // reads the contents, which must still exist
}

} // namespace fenestra::core
