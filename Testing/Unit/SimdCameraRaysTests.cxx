// Camera rays and primary samples of SIMD code against scalar code, on each instruction set.

#include "integrator/simd/CameraRays.h"

#include "EachInstructionSet.h"
#include "Support.h"

namespace fenestra::core::testing::SimdCameraRaysTests {
namespace {

class SimdCameraRays : public InstructionSetTest {};

constexpr int width = 40, height = 30;

struct View {
  std::string name;
  CameraPose pose;
  Clip clip = ClipNone{};
  std::optional<CropBox> crop = {};
};

CameraPose makePose(Projection projection, const Vec3& position, double extent) {
  CameraPose result;
  result.projection = projection;
  result.position = position;
  result.target = {1.0, 2.0, 3.0};
  result.up = Vec3(0.2, 0.1, 1.0);
  result.scale = extent;
  result.angle = extent;
  return result;
}

std::vector<View> makeViews() {
  const Affine box = makeRotation(0.4, Vec3(1.0, 2.0, 2.0) / 3.0);
  const CameraPose near = makePose(Projection::perspective, {-30.0, -80.0, 20.0}, 30.0);
  const CropBox crop(Affine(15.0 * box.linear(), Vec3(2.0, 1.0, 0.0)));
  return {{"orthographic", makePose(Projection::orthographic, {-60.0, -80.0, 20.0}, 40.0)},
          {"perspective", near},
          {"within", makePose(Projection::perspective, {-3.0, 4.0, 5.0}, 100.0)},
          {"far", makePose(Projection::perspective, {-3e7, -8e7, 2e7}, 5e-5)},
          {"far, orthographic", makePose(Projection::orthographic, {-3e7, -8e7, 2e7}, 40.0)},
          {"cropped", near, ClipNone{}, crop},
          {"clipped", near,
           ClipPlane{Camera(near, width, height), Vec3::Zero(), Vec3(0.0, -1.0, 0.3).normalized()},
           crop}};
}

/// Everything needed to start paths in a scene.
struct PathSetup {
  Domain domain;
  SimdTracker tracker;
  Background background = {};
  CameraRays cameraRays;
  CameraTable cameraTable;
  std::unique_ptr<CameraSamples> samples = std::make_unique<CameraSamples>();
  std::unique_ptr<PathBatch> paths = std::make_unique<PathBatch>();

  PathSetup(const SceneView& s, const Domain& in)
      : domain(in),
        tracker(s.volume, domain, s.transfer, s.majorants, s.clip),
        cameraRays(s.camera, s.clip, s.lights, background),
        cameraTable(domain, s.camera) {}
};

/// One camera sample in each of consecutive pixels.
void fill(CameraSamples& samples, const Sampler& source, std::uint64_t pixel,
          std::uint64_t sample) {
  samples.isStratified = source.isStratified();
  for (samples.size = 0; samples.size < RayBatch::capacity - 50; ++samples.size) {
    const std::uint64_t pixelIndex = pixel + samples.size, sampleIndex = sample + samples.size;
    const Sampler::Stream stream = source.stream(pixelIndex, sampleIndex);
    samples.column[samples.size] = static_cast<float>(pixelIndex % width);
    samples.row[samples.size] = static_cast<float>(pixelIndex / width);
    samples.start[samples.size] = stream.start;
    samples.key[samples.size] = stream.key;
    samples.number[samples.size] = static_cast<std::uint32_t>(sampleIndex % stream.maxSamples);
    samples.tile[samples.size] = 7;
    samples.tileSample[samples.size] = static_cast<std::uint32_t>(pixelIndex);
  }
}

TEST_P(SimdCameraRays, SamplesEqualThoseOfTheSampler) {
  const Grid grid = makeCenteredGrid({30, 20, 40}, {1.0, 1.5, 0.8});
  const Volume volume = makeVolume(grid, [](const Vec3&) { return 1.0; });
  TestScene scene{volume, makeLinearTransfer(0.1, Rgb::Ones()), {}, makeViews()[0].pose, width,
                  height};
  scene.visitView([&](const SceneView& s) {
    const PathSetup setup(s, Domain(grid));
    const auto& [domain, tracker, background, cameraRays, cameraTable, samples, paths] = setup;
    constexpr std::uint64_t streamLength = Sampler::Stream::maxSamples;
    for (const Sampling sampling : {Sampling::stratified, Sampling::independent})
      for (const std::uint64_t sample : {std::uint64_t{0}, streamLength - 100, streamLength << 9}) {
        const Sampler source(sampling, 5);
        fill(*samples, source, 400, sample);
        paths->rays.size = 0;
        beginPaths(tracker.medium(), cameraTable, cameraRays, *samples, *paths);
        ASSERT_EQ(paths->rays.size, samples->size);
        const auto toUnitFloat = [](std::uint64_t bits) {
          return static_cast<float>(bits >> 8 & 0xffffff) * 0x1p-24F;
        };
        for (std::size_t i = 0; i < samples->size; ++i) {
          const PrimarySamples numbers = source.generate(400 + i, sample + i);
          ASSERT_EQ(paths->rays.depthBits[i], numbers.opticalDepth >> 32) << i;
          ASSERT_EQ(paths->rays.acceptance[i], toUnitFloat(numbers.acceptance >> 32)) << i;
          ASSERT_EQ(paths->uDirection[0][i], toUnitFloat(numbers.direction >> 32)) << i;
          ASSERT_EQ(paths->uDirection[1][i], toUnitFloat(numbers.direction)) << i;
          const Vec2 choices = toUniform2(numbers.choices);
          ASSERT_NEAR(double{paths->uChoices[0][i]}, choices.x(), 2e-7) << i;
          ASSERT_NEAR(double{paths->uChoices[1][i]}, choices.y(), 2e-7) << i;
          ASSERT_EQ(std::uint64_t{paths->counter[i]} << 32 | paths->key[i], numbers.pathSeed) << i;
          const Vec2 jitter = toUniform2(numbers.position);
          const std::uint64_t pixel = 400 + i;
          ASSERT_NEAR(double{samples->column[i]} + 0.5 * width, double(pixel % width) + jitter.x(),
                      2e-6);
          ASSERT_NEAR(double{samples->row[i]} + 0.5 * height, double(pixel / width) + jitter.y(),
                      2e-6);
          ASSERT_EQ(paths->row[i], static_cast<float>(pixel / width));
          ASSERT_EQ(paths->tileSample[i], pixel);
        }
      }
  });
}

/// Origins, lengths and depths match double precision within a few ulps of the volume's extent, at
/// any distance of the camera.
TEST_P(SimdCameraRays, RaysMatchDoublePrecision) {
  const Grid grid = makeCenteredGrid({30, 20, 40}, {1.0, 1.5, 0.8});
  const Volume volume = makeVolume(grid, [](const Vec3&) { return 1.0; });
  for (const View& view : makeViews()) {
    SCOPED_TRACE(view.name);
    TestScene scene{volume,   makeLinearTransfer(0.1, Rgb::Ones()), {}, view.pose, width, height,
                    view.clip};
    scene.visitView([&](const SceneView& s) {
      const PathSetup setup(s, Domain(grid, view.crop));
      const auto& [domain, tracker, background, cameraRays, cameraTable, samples, paths] = setup;
      const auto exact = std::make_unique<RayBatch>();
      std::size_t hits = 0;
      for (std::uint64_t pixel = 0; pixel + RayBatch::capacity < width * height; pixel += 400) {
        fill(*samples, Sampler(Sampling::stratified, pixel), pixel, 0);
        paths->rays.size = 3; // the new rays are appended
        beginPaths(tracker.medium(), cameraTable, cameraRays, *samples, *paths);
        for (std::size_t i = 0; i < samples->size; ++i) {
          const std::size_t at = i + 3;
          const Ray ray = cameraRays.ray(double{samples->column[i]} + 0.5 * width,
                                         double{samples->row[i]} + 0.5 * height);
          setDomainRay(*exact, i, domain, ray, cameraRays.range(ray));
          ASSERT_NEAR(exact->length[i], paths->rays.length[at], 2e-4);
          for (std::size_t axis = 0; axis < 3; ++axis)
            ASSERT_NEAR(ray.direction[static_cast<int>(axis)], paths->direction[axis][at], 2e-7);
          if (exact->length[i] < 1e-3F)
            continue;
          ++hits;
          const double distance =
              (cameraTable.nearDepth + double{paths->depth[at]}) / cameraRays.depth(ray, 1.0);
          const Vec3 origin = grid.worldToIndex * ray.at(distance);
          for (std::size_t axis = 0; axis < 3; ++axis) {
            ASSERT_NEAR(exact->direction[axis][i], paths->rays.direction[axis][at], 3e-7);
            ASSERT_NEAR(exact->origin[axis][i], paths->rays.origin[axis][at], 2e-4);
            ASSERT_NEAR(origin[static_cast<int>(axis)], paths->rays.origin[axis][at], 1e-5);
          }
          ASSERT_NEAR(cameraRays.depth(ray, 1.0), paths->depthPerLength[at], 2e-7);
        }
      }
      EXPECT_GT(hits, 100U);
    });
  }
}

INSTANTIATE_TEST_SUITE_P(InstructionSets, SimdCameraRays, allInstructionSets);

} // namespace
} // namespace fenestra::core::testing::SimdCameraRaysTests
