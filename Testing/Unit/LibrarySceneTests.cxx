// The public interface: options of scenes, presets, files, what a scene tells.

#include "LibraryTesting.h"
#include "TemporaryFolder.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace fenestra::testing_library {
namespace {

TEST(LibraryScene, RefusesImpossibleOptions) {
  const Ball ball;
  const auto make = [&](const auto& change) {
    SceneOptions options = makeOptions();
    change(options);
    return findCode([&] { Scene(ball.volume, ball.segments, options); });
  };
  EXPECT_EQ(make([](SceneOptions&) {}), "no error");
  EXPECT_EQ(make([](SceneOptions& o) { o.focus = {"cube"}; }), "unknown-name");
  EXPECT_EQ(make([](SceneOptions& o) { o.clip.ghost = 2.0; }), "invalid-value");
  EXPECT_EQ(make([](SceneOptions& o) { o.appearance.density = std::nan(""); }), "invalid-value");
  EXPECT_EQ(make([](SceneOptions& o) {
              o.view.position = {{0, std::nan(""), 0}};
            }),
            "invalid-value");
  EXPECT_EQ(make([](SceneOptions& o) {
              o.clip.plane = Plane{{0, 0, 0}, {0, 0, 0}};
            }),
            "invalid-value");
  EXPECT_EQ(findCode([&] { Scene(ball.volume, makeOptions()); }), "segmentation-required");
  EXPECT_EQ(make([](SceneOptions& o) {
              o.focus.clear();
              o.clip.mode = ClipMode::cutaway;
            }),
            "focus-required");
}

std::string writePreset(const core::TemporaryFolder& folder, const std::string& flags) {
  folder.write("preset.json", R"({"title": "Ball", "modality": "CT", "focus": {"names": ["ball"]},
    "flags": )" + flags + "}");
  return (folder / "preset.json").string();
}

TEST(LibraryScene, PresetSuppliesOptionsWithoutValue) {
  const core::TemporaryFolder folder;
  const Ball ball;
  SceneOptions written = makeOptions();
  written.view = {.name = "left", .up = Vector3{0, 1, 1}, .scale = 20.0};
  written.clip.softness = 1.5;
  written.appearance.transfer = "ct-bone";
  SceneOptions preset = makeOptions();
  preset.focus.clear();
  preset.view.scale = 20.0;
  preset.preset = writePreset(folder, R"({"view": "left", "up": [0, 1, 1], "scale": 90,
    "clip-softness": 1.5, "transfer": "ct-bone"})");
  const Scene scene(ball.volume, ball.segments, preset);
  const Image image = render(scene, makeSmall());
  EXPECT_EQ(copy(image.rgba()),
            copy(render({ball.volume, ball.segments, written}, makeSmall()).rgba()));
  EXPECT_EQ(image.metadata().at("preset"), "preset");
  preset.view.name = written.view.name = "superior";
  preset.view.up = written.view.up = {};
  preset.appearance.transfer = "ct-bone";
  preset.preset = writePreset(folder, R"({"position": [0, 300, 0], "angle": 20,
    "clip-softness": 1.5, "transfer": "ct-skin"})");
  EXPECT_EQ(copy(render(scene.withOptions(preset), makeSmall()).rgba()),
            copy(render({ball.volume, ball.segments, written}, makeSmall()).rgba()));
}

TEST(LibraryScene, FilesFailBeforeTheRender) {
  const core::TemporaryFolder folder;
  const std::string header = "NRRD0004\ntype: uint8\ndimension: 3\nspace: right-anterior-superior\n"
                             "sizes: 4 4 4\nspace directions: (1,0,0) (0,1,0) (0,0,1)\n"
                             "space origin: (0,0,0)\nencoding: raw\n";
  folder.write("volume.nrrd", header + "\n" + std::string(64, 'a'));
  folder.write("organs.seg.nrrd", header +
                                      "Segment0_ID:=S\nSegment0_Name:=Liver\n"
                                      "Segment0_LabelValue:=1\n\n" +
                                      std::string(64, '\1'));
  const std::string volume = (folder / "volume.nrrd").string();
  const std::string organs = (folder / "organs.seg.nrrd").string();
  const auto findSceneCode = [&](const std::string& path, const char* focus) {
    SceneOptions options;
    options.focus = {focus};
    return findCode([&] { readScene(path, organs, {}, options); });
  };
  EXPECT_EQ(findSceneCode(volume, "Liver"), "no error");
  EXPECT_EQ(findSceneCode(volume, "Kidney"), "unknown-name");
  EXPECT_EQ(findSceneCode(volume + "x", "Liver"), "missing-file");
  ASSERT_EQ(readScene(volume, organs).segments().size(), 1u);
  EXPECT_EQ(readScene(volume, organs).segments().front().name, "Liver");
  EXPECT_TRUE(readScene(volume).segments().empty());
}

TEST(LibraryScene, SegmentsAtAnotherPlaceGiveAWarning) {
  const Ball ball;
  const auto count = [&](double shift) {
    Affine map = millimeters;
    map[2][3] += shift;
    const Segmentation segments(pack(ball.labels, SampleType::uint8), map, {{3, "ball"}});
    return Scene(ball.volume, segments, makeOptions()).withOptions(makeOptions()).warnings().size();
  };
  EXPECT_EQ(count(0.0), 0u);
  EXPECT_EQ(count(4.0), 1u);
}

TEST(LibraryScene, AutomaticPresetSuitsTheNamesOfSegments) {
  const Ball ball;
  const Segmentation liver(pack(ball.labels, SampleType::uint8), millimeters, {{3, "Liver"}});
  SceneOptions options;
  for (const char* name : {"liver", "auto"}) {
    options.preset = name;
    const Scene scene(ball.volume, liver, options);
    EXPECT_EQ(render(scene, makeSmall()).metadata().at("preset"), "liver");
    EXPECT_GT(scene.clipSurface(24, 16).points.size(), 0u) << name;
    EXPECT_EQ(scene.options().preset, name);
    for (const Scene& either : {scene, scene.withOptions(options)}) // by modality: it sets none
      EXPECT_EQ(either.choices(24, 16).front().find("(by the preset)"), std::string::npos);
  }
  const auto findPresetCode = [&](const char* name, const auto&... segments) {
    options.preset = name;
    return findCode([&] { Scene(ball.volume, segments..., options); });
  };
  EXPECT_EQ(findPresetCode("spine", liver), "no-matching-preset");
  EXPECT_EQ(findPresetCode("auto", ball.segments), "no-matching-preset");
  EXPECT_EQ(findPresetCode("no such preset", liver), "unknown-name");
  EXPECT_EQ(findPresetCode("auto"), "segmentation-required");
  EXPECT_EQ(findPresetCode("liver"), "no error"); // its view alone
}

TEST(LibraryScene, RefusesPresetsThatItCannotApply) {
  const core::TemporaryFolder folder;
  const Ball ball;
  for (const char* flags : {R"({"clip": "hole"})", R"({"scale": "large"})", R"({"up": [1, 2]})"}) {
    SceneOptions options;
    options.preset = writePreset(folder, flags);
    EXPECT_EQ(findCode([&] { Scene(ball.volume, ball.segments, options); }), "invalid-field")
        << flags;
  }
}

TEST(LibraryScene, ChangedSceneEqualsANewOne) {
  const Ball ball;
  const Scene first(ball.volume, ball.segments, makeOptions());
  render(first, makeSmall());
  SceneOptions options = makeOptions();
  options.view.name = "left";
  options.clip.mode = ClipMode::ghost;
  EXPECT_EQ(copy(render(first.withOptions(options), makeSmall()).rgba()),
            copy(render(Scene(ball.volume, ball.segments, options), makeSmall()).rgba()));
  EXPECT_EQ(findCode([&] { first.withOptions({.focus = {"cube"}}); }), "unknown-name");
}

TEST(LibraryScene, HasACameraAndASurface) {
  const Ball ball;
  const Scene scene(ball.volume, ball.segments, makeOptions());
  const Camera camera = scene.camera(24, 16);
  EXPECT_EQ(camera.projection, Projection::orthographic);
  EXPECT_GT(camera.position[1], 24.0); // anterior of the block
  const ClipSurface surface = scene.clipSurface(24, 16);
  EXPECT_GT(surface.triangles.size(), 10U);
  EXPECT_EQ(surface.points.size(), surface.depths.size());
  EXPECT_EQ(findCode([&] { Scene(ball.volume).clipSurface(24, 16); }), "focus-required");
}

} // namespace
} // namespace fenestra::testing_library
