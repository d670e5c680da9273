// The public interface: volumes and segmentations in memory, renders, images.

#include "fenestra/Fenestra.h"

#include "TemporaryFolder.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <cstring>
#include <fstream>
#include <future>
#include <limits>
#include <thread>

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace fenestra::testing_library {
namespace {

constexpr int edge = 24; // voxels
constexpr Affine millimeters = {{{2, 0, 0, -24}, {0, 2, 0, -24}, {0, 0, 2, -24}}};

/// Voxels of a ball in a block, i fastest.
template <typename T>
std::vector<T> makeBall(double inside, double outside) {
  std::vector<T> voxels;
  for (int k = 0; k < edge; ++k)
    for (int j = 0; j < edge; ++j)
      for (int i = 0; i < edge; ++i) {
        const double distance = std::hypot(i - 11.5, j - 11.5, k - 11.5);
        voxels.push_back(static_cast<T>(distance < 6.0 ? inside + i - 2 * j : outside + k));
      }
  return voxels;
}

Samples pack(const auto& voxels, SampleType type) {
  return {.data = voxels.data(), .type = type, .size = {edge, edge, edge}};
}

struct Ball {
  std::vector<std::int16_t> voxels = makeBall<std::int16_t>(300, 40);
  std::vector<std::uint8_t> labels;
  Volume volume{pack(voxels, SampleType::int16), millimeters, {.modality = Modality::ct}};
  Segmentation segments;

  Ball()
      : labels(makeLabels()),
        segments(pack(labels, SampleType::uint8), millimeters, {{3, "ball"}}) {}

private:
  std::vector<std::uint8_t> makeLabels() const {
    std::vector<std::uint8_t> all;
    for (const std::int16_t voxel : voxels)
      all.push_back(voxel > 150 ? 3 : 0);
    return all;
  }
};

SceneOptions makeOptions() {
  SceneOptions options;
  options.focus = {"ball"};
  options.appearance.smoothing.kind = VolumeSmoothing::Kind::off;
  return options;
}

RenderOptions makeSmall(std::uint64_t samples = 2) {
  return {.width = 24, .height = 16, .samples = samples};
}

std::vector<float> copy(std::span<const float> values) {
  return {values.begin(), values.end()};
}

std::string findCode(const auto& work) {
  try {
    work();
  } catch (const Error& error) {
    return error.code();
  }
  return "no error";
}

// ---- volumes

/// Image of a volume without focus, which depends on all of its voxels.
std::vector<float> renderVolume(const Samples& samples) {
  SceneOptions options;
  options.appearance.transfer = "ct-bone";
  options.appearance.smoothing.kind = VolumeSmoothing::Kind::off;
  return copy(render(Scene(Volume(samples, millimeters), options), makeSmall()).rgba());
}

TEST(LibraryVolume, EqualSamplesOfAnyTypeGiveEqualImages) {
  const auto expected = renderVolume(pack(makeBall<std::int16_t>(300, 40), SampleType::int16));
  const auto check = [&]<typename T>(T, SampleType type) {
    const std::vector<T> voxels = makeBall<T>(300, 40);
    EXPECT_EQ(renderVolume(pack(voxels, type)), expected);
  };
  check(std::uint16_t(), SampleType::uint16);
  check(std::int32_t(), SampleType::int32);
  check(std::uint32_t(), SampleType::uint32);
  check(std::int64_t(), SampleType::int64);
  check(std::uint64_t(), SampleType::uint64);
  check(float(), SampleType::float32);
  check(double(), SampleType::float64);
}

TEST(LibraryVolume, StridesAndByteOrderDoNotMatter) {
  const std::vector<std::int16_t> voxels = makeBall<std::int16_t>(300, 40);
  const std::vector<float> expected = renderVolume(pack(voxels, SampleType::int16));
  std::vector<std::int16_t> transposed(voxels.size()), swapped, mirrored(voxels.size());
  for (std::size_t k = 0; k < edge; ++k)
    for (std::size_t j = 0; j < edge; ++j)
      for (std::size_t i = 0; i < edge; ++i) {
        const std::int16_t voxel = voxels[i + edge * (j + edge * k)];
        transposed[k + edge * (j + edge * i)] = voxel;
        mirrored[edge - 1 - i + edge * (j + edge * (edge - 1 - k))] = voxel;
      }
  for (const std::int16_t voxel : voxels)
    swapped.push_back(
        static_cast<std::int16_t>(__builtin_bswap16(static_cast<std::uint16_t>(voxel))));
  Samples samples = pack(transposed, SampleType::int16);
  samples.strides = {2 * edge * edge, 2 * edge, 2};
  EXPECT_EQ(renderVolume(samples), expected);
  samples = pack(swapped, SampleType::int16);
  samples.isSwapped = true;
  EXPECT_EQ(renderVolume(samples), expected);
  samples = pack(mirrored, SampleType::int16);
  samples.data = &mirrored.back() - (edge * edge - edge);
  samples.strides = {-2, 2 * edge, -2 * edge * edge};
  EXPECT_EQ(renderVolume(samples), expected);
}

TEST(LibraryVolume, DescribesItself) {
  const std::vector<std::int16_t> voxels = makeBall<std::int16_t>(300, 40);
  const Volume volume(pack(voxels, SampleType::int16), millimeters,
                      {.name = "scan", .modality = Modality::mr});
  EXPECT_EQ(volume.size(), (std::array<std::int64_t, 3>{edge, edge, edge}));
  EXPECT_EQ(volume.indexToWorld(), millimeters);
  EXPECT_EQ(volume.range()[0], 40.0);
  EXPECT_EQ(volume.name(), "scan");
  EXPECT_EQ(volume.modality(), Modality::mr);
  std::vector<float> damaged = makeBall<float>(300, 40);
  damaged[5] = std::numeric_limits<float>::quiet_NaN();
  const Volume repaired(pack(damaged, SampleType::float32), millimeters);
  ASSERT_EQ(repaired.warnings().size(), 1U);
  EXPECT_EQ(repaired.warnings().front().code, "non-finite-voxels");
}

TEST(LibraryVolume, RefusesImpossibleArrays) {
  const std::vector<std::int16_t> voxels(8, 1);
  const auto make = [&](const Samples& samples, const Affine& affine) {
    return findCode([&] { Volume(samples, affine); });
  };
  const Samples good{.data = voxels.data(), .size = {2, 2, 2}};
  EXPECT_EQ(make(good, millimeters), "no error");
  EXPECT_EQ(make({.data = voxels.data(), .size = {2, 0, 2}}, millimeters), "invalid-field");
  EXPECT_EQ(make({.data = voxels.data(), .size = {2, -1, -2}}, millimeters), "invalid-field");
  EXPECT_EQ(make({.data = voxels.data(), .size = {1 << 30, 1 << 30, 1 << 30}}, millimeters),
            "invalid-field");
  EXPECT_EQ(make({.size = {2, 2, 2}}, millimeters), "invalid-field");
  EXPECT_EQ(make(good, {{{1, 0, 0, 0}, {2, 0, 0, 0}, {0, 0, 1, 0}}}), "invalid-field");
  EXPECT_EQ(make(good, {{{1, 0, 0, std::nan("")}, {0, 1, 0, 0}, {0, 0, 1, 0}}}), "invalid-field");
}

// ---- segmentations

TEST(LibrarySegmentation, MasksAndLabelsGiveEqualImages) {
  const Ball ball;
  const Segmentation masks({{"ball", pack(ball.labels, SampleType::uint8)}}, millimeters);
  ASSERT_EQ(masks.segments().size(), 1U);
  EXPECT_EQ(copy(render(Scene(ball.volume, masks, makeOptions()), makeSmall()).rgba()),
            copy(render(Scene(ball.volume, ball.segments, makeOptions()), makeSmall()).rgba()));
}

TEST(LibrarySegmentation, ReadsTablesOfNames) {
  EXPECT_EQ(readLabelNames("totalsegmentator2").at(5), "liver");
  EXPECT_EQ(findCode([] { readLabelNames("no such table.json"); }), "missing-file");
}

TEST(LibrarySegmentation, NamesItsSegments) {
  const Ball ball;
  ASSERT_EQ(ball.segments.segments().size(), 1U);
  EXPECT_EQ(ball.segments.segments().front().name, "ball");
  EXPECT_EQ(ball.segments.segments().front().label, 3);
  const std::vector<float> fractions(edge * edge * edge, 0.5F);
  EXPECT_EQ(findCode([&] { Segmentation(pack(fractions, SampleType::float32), millimeters); }),
            "unsupported-file");
  EXPECT_EQ(findCode([&] { Segmentation(std::vector<SegmentMask>(), millimeters); }),
            "invalid-field");
}

// ---- scenes

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

// ---- renders

TEST(LibraryRender, ImageHasItsLayers) {
  const Ball ball;
  const Image image = render(Scene(ball.volume, ball.segments, makeOptions()), makeSmall(4));
  const std::size_t pixels = 24 * 16;
  EXPECT_EQ(image.rgba().size(), 4 * pixels);
  EXPECT_EQ(image.denoised().size(), 4 * pixels);
  EXPECT_EQ(image.depth().size(), pixels);
  EXPECT_EQ(image.clipDepth().size(), pixels);
  EXPECT_EQ(image.normals().size(), 3 * pixels);
  EXPECT_EQ(image.albedo().size(), 3 * pixels);
  EXPECT_EQ(image.error().size(), 3 * pixels);
  EXPECT_EQ(image.sampleCounts().size(), pixels);
  EXPECT_EQ(image.samples(), 4U);
  EXPECT_TRUE(image.isComplete());
  EXPECT_GT(image.noise(), 0.0);
  EXPECT_EQ(image.display().size(), 4 * pixels);
  EXPECT_EQ(image.metadata().at("seed"), "0");
  RenderOptions raw = makeSmall();
  raw.isDenoised = false;
  EXPECT_TRUE(render(Scene(ball.volume), raw).denoised().empty());
}

TEST(LibraryRender, RefusesImpossibleOptions) {
  const Ball ball;
  const Scene scene(ball.volume);
  const auto code = [&](const RenderOptions& options) {
    return findCode([&] { render(scene, options); });
  };
  EXPECT_EQ(code({.width = 0}), "invalid-value");
  EXPECT_EQ(code({.samples = 0}), "invalid-value");
  EXPECT_EQ(code({.noise = -1.0}), "invalid-value");
  EXPECT_EQ(code({.seconds = std::nan("")}), "invalid-value");
  EXPECT_EQ(code({.threads = -1}), "invalid-value");
}

TEST(LibraryRender, CallbackStopsIt) {
  const Ball ball;
  const Scene scene(ball.volume, ball.segments, makeOptions());
  constexpr std::uint64_t samples = std::uint64_t{1} << 30;
  const Image image =
      render(scene, makeSmall(samples), // stops after a complete pass
             [](const Progress& progress) { return progress.fraction * double{samples} < 2.0; });
  EXPECT_FALSE(image.isComplete());
  EXPECT_GT(image.samples(), 0U);
}

TEST(LibraryRender, ExceptionOfTheCallbackStopsIt) {
  const Ball ball;
  const std::thread::id caller = std::this_thread::get_id();
  const auto onProgress = [&](const Progress&) -> bool {
    EXPECT_EQ(std::this_thread::get_id(), caller);
    throw std::runtime_error("of the caller");
  };
  EXPECT_THROW(render(Scene(ball.volume), makeSmall(std::uint64_t{1} << 30), onProgress),
               std::runtime_error);
}

TEST(LibraryRender, ThreadsAndConcurrentRendersDoNotChangeTheImage) {
  const Ball ball;
  const Scene scene(ball.volume, ball.segments, makeOptions());
  SceneOptions options = makeOptions();
  options.view.name = "superior";
  const Scene other = scene.withOptions(options);
  RenderOptions one = makeSmall();
  one.threads = 1;
  const auto expected = copy(render(scene, one).rgba()),
             fromAbove = copy(render(other, one).rgba());
  EXPECT_NE(expected, fromAbove);
  const auto start = [](const Scene& which) {
    return std::async(std::launch::async,
                      [which] { return copy(render(which, makeSmall()).rgba()); });
  };
  auto first = start(scene), second = start(other), third = start(scene);
  EXPECT_EQ(first.get(), expected);
  EXPECT_EQ(second.get(), fromAbove);
  EXPECT_EQ(third.get(), expected);
}

TEST(LibraryRender, ForkedProcessIsRefused) {
  const Ball ball;
  const Scene scene(ball.volume);
  render(scene, makeSmall());
  const pid_t child = ::fork();
  if (child == 0)
    ::_exit(findCode([&] { render(scene, makeSmall()); }) == "forked-process" ? 0 : 1);
  int status = 1;
  ::waitpid(child, &status, 0);
  EXPECT_EQ(status, 0);
}

TEST(LibraryRender, ArraysNeedNoFileAndNoProcess) {
  const Ball ball;
  rusage before = {}, after = {};
  ::getrusage(RUSAGE_CHILDREN, &before);
  const core::TemporaryFolder folder;
  const std::filesystem::path previous = std::filesystem::current_path();
  ::setenv("TMPDIR", folder.path().c_str(), 1);
  std::filesystem::current_path(folder.path());
  const Image image = render(Scene(ball.volume, ball.segments, makeOptions()), makeSmall());
  EXPECT_GT(image.png().size(), 100U);
  std::filesystem::current_path(previous);
  ::unsetenv("TMPDIR");
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
  ::getrusage(RUSAGE_CHILDREN, &after);
  EXPECT_EQ(before.ru_maxrss, after.ru_maxrss);
  EXPECT_EQ(before.ru_minflt, after.ru_minflt);
}

// ---- files

TEST(LibraryFiles, SavesImages) {
  const core::TemporaryFolder folder;
  const Ball ball;
  const Image image = render(Scene(ball.volume, ball.segments, makeOptions()), makeSmall());
  const std::string png = (folder.path() / "a.png").string();
  image.save(png);
  image.save(png); // replaces it
  std::ifstream file(png, std::ios::binary);
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(file), {}), image.png());
  for (const char* name : {"a.exr", "a.nrrd", "a.tif"}) {
    image.save((folder.path() / name).string());
    EXPECT_TRUE(std::filesystem::exists(folder.path() / name)) << name;
  }
  EXPECT_EQ(findCode([&] { image.save((folder.path() / "a.bmp").string()); }), "unsupported-file");
  EXPECT_EQ(findCode([&] { image.save((folder.path() / "b" / "a.png").string()); }),
            "unwritable-file");
}

TEST(LibraryFiles, ImageMayReplaceWhatWasRead) {
  const core::TemporaryFolder folder;
  const Ball ball;
  const std::string path = (folder.path() / "a.nrrd").string();
  RenderOptions raw = makeSmall();
  raw.isDenoised = false;
  const Image image = render(Scene(ball.volume), raw);
  image.save((folder.path() / "a.nrrd").string());
  const std::string depth = (folder.path() / "a-Z.nrrd").string();
  EXPECT_EQ(readVolume(depth).size(), (std::array<std::int64_t, 3>{24, 16, 1}));
  image.save(path);
  EXPECT_EQ(readVolume(depth).size()[0], 24);
}

TEST(LibraryFiles, ScaleBarNeedsAnOrthographicProjection) {
  const Ball ball;
  SceneOptions options = makeOptions();
  options.view.projection = Projection::perspective;
  const Image image = render(Scene(ball.volume, ball.segments, options), makeSmall());
  EXPECT_EQ(findCode([&] { image.png({.hasScale = true}); }), "scale-of-perspective-camera");
  EXPECT_GT(image.png({.hasOrientation = true}).size(), 100U);
}

} // namespace
} // namespace fenestra::testing_library
