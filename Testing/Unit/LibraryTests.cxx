// The public interface: volumes and segmentations in memory, renders, images.

#include "LibraryTesting.h"
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
