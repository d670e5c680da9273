// Presets of an installed 3D Slicer: where they are searched, and their content.

#include "files/slicer/SlicerPresets.h"

#include "files/slicer/MrmlScene.h"
#include "io/JsonNode.h"

#include "Refusals.h"

#include <cstdlib>

namespace fenestra::core::SlicerPresetsTests {
namespace {

constexpr const char* presetsText = R"(<?xml version="1.0" encoding="UTF-8"?>
<MRML>
  <VolumeProperty name="CT-Mine" scalarOpacity="4 0 0 100 0.5" gradientOpacity="4 0 1 255 1"
    colorTransfer="8 0 0 0 0 100 1 1 1" shade="1" effectiveRange="0 0 1 2"/>
  <VolumeProperty name="Broken" scalarOpacity="3 0 0 100" colorTransfer="4 0 1 1 1"/>
</MRML>)";

/// Sets an environment variable for its own lifetime.
class ScopedVariable {
public:
  ScopedVariable(const char* name, const std::string& value) : m_name(name) {
    if (const char* before = std::getenv(name))
      m_before = before;
    ::setenv(name, value.c_str(), 1);
  }
  ~ScopedVariable() { m_before ? ::setenv(m_name, m_before->c_str(), 1) : ::unsetenv(m_name); }
  ScopedVariable(const ScopedVariable&) = delete;
  ScopedVariable& operator=(const ScopedVariable&) = delete;

private:
  const char* m_name;
  std::optional<std::string> m_before;
};

/// Creates the files of a Slicer installation that matter; returns the path of its presets.
std::filesystem::path installPresets(const TemporaryFolder& folder, const std::string& home,
                                     const std::string& version) {
  const auto moduleFolder =
      folder / home / "share" / ("Slicer-" + version) / "qt-loadable-modules" / "VolumeRendering";
  std::filesystem::create_directories(moduleFolder);
  std::ofstream(moduleFolder / "presets.xml") << presetsText;
  std::ofstream(folder / home / "Slicer") << "launcher";
  return moduleFolder / "presets.xml";
}

TEST(SlicerPresets, AreFoundInSlicerHome) {
  const TemporaryFolder folder;
  const auto presets = installPresets(folder, "home", "5.8");
  const ScopedVariable path("PATH", "/nowhere");
  {
    const ScopedVariable home("SLICER_HOME", (folder / "home").string());
    EXPECT_EQ(findSlicerPresets(), presets);
  }
  const ScopedVariable home("SLICER_HOME", (folder / "none").string());
  EXPECT_FALSE(findSlicerPresets());
}

TEST(SlicerPresets, AreFoundBesideTheLauncherInPath) {
  const TemporaryFolder folder;
  const auto presets = installPresets(folder, "home", "5.8");
  std::filesystem::create_directory(folder / "bin");
  std::filesystem::create_symlink(folder / "home" / "Slicer", folder / "bin" / "Slicer");
  const ScopedVariable home("SLICER_HOME", "");
  const ScopedVariable path("PATH", "/nowhere::" + (folder / "bin").string());
  ASSERT_TRUE(findSlicerPresets());
  EXPECT_TRUE(std::filesystem::equivalent(*findSlicerPresets(), presets));
}

TEST(SlicerPresets, AreNamedVolumeProperties) {
  const MrmlDocument presets(presetsText, "presets.xml");
  EXPECT_EQ(listPropertyNames(presets), (std::vector<std::string>{"CT-Mine", "Broken"}));
  const auto properties = presets.findByTag("VolumeProperty");
  const TransferFunction function = readInlineProperty(presets, *properties.at(0));
  EXPECT_NEAR(function.extinction(50)[0], -std::log(0.75), 1e-3); // opacity 0.25 over 1 mm
  EXPECT_TRUE(function.shading);
  expectRefused("presets.xml", "invalid-field: VolumeProperty Broken: scalarOpacity",
                [&] { readInlineProperty(presets, *properties.at(1)); });
}

TEST(SlicerPresets, EveryPresetOfARealSlicerCanBeRead) {
  const std::filesystem::path file =
      std::filesystem::path(FENESTRA_DATA) / "slicer_scenes" / "slicer_core" / "presets.xml";
  if (!std::filesystem::exists(file))
    GTEST_SKIP() << "no test data at " << FENESTRA_DATA;
  const MrmlDocument presets(readText(file), file.string());
  EXPECT_EQ(listPropertyNames(presets).size(), 31u);
  for (const MrmlNode* node : presets.findByTag("VolumeProperty"))
    EXPECT_GT(readInlineProperty(presets, *node).extinction.range(-4000, 70000)[1], 0.0)
        << node->name;
}

} // namespace
} // namespace fenestra::core::SlicerPresetsTests
