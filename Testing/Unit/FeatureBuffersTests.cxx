// Feature buffers compared with closed forms and with the means of samples, and SIMD ray marching
// with scalar.

#include "ClippingTesting.h"
#include "Support.h"
#include "clip/surface/ClippingSurface.h"
#include "denoise/features/FeatureBuffers.h"
#include "denoise/features/RayMarcher.h"

#include <gtest/gtest.h>

namespace fenestra::core::testing::FeatureBuffersTests {
namespace {

FeatureBuffers renderFeatures(const TestScene& s) {
  return s.visitView([](const SceneView& scene) { return computeFeatures(scene); });
}

/// Slab of 10 mm with constant extinction, seen face-on by parallel rays from 50 mm in front of it.
TestScene makeSlab(double extinction) {
  TestScene s{
      makeVolume(makeCenteredGrid({10, 40, 40}, {1.0, 1.0, 1.0}), [](const Vec3&) { return 1.0; }),
      makeLinearTransfer(extinction, Rgb(0.9, 0.5, 0.1)),
      {},
      {.position = {-55, 0, 0}, .target = Vec3::Zero(), .scale = 8.0}};
  return s;
}

/// Wavy medium with hybrid shading, partly outside the image.
TestScene makeWaves() {
  TestScene s{makeVolume<std::int16_t>(makeCenteredGrid({24, 24, 24}, {1.0, 1.0, 1.5}),
                                       [](const Vec3& p) {
                                         return 100.0 * std::sin(0.5 * p.x()) *
                                                std::cos(0.4 * p.y() + 0.3 * p.z());
                                       }),
              {ScalarFunction({makeKnot(-20.0, 0.0), makeKnot(100.0, 0.8)}),
               ColorFunction({{0.0, Rgb(0.9, 0.8, 0.7)}, {100.0, Rgb(0.2, 0.3, 0.9)}}),
               {},
               0.4,
               SurfaceShading{}},
              {DirectionalLight{}},
              {.position = {10, -60, 20}, .target = Vec3::Zero(), .scale = 14.0},
              41,
              29};
  return s;
}

/// Soft clip edge at a tilted surface through the target.
Clip makeTiltedClip(const TestScene& s) {
  const Camera camera(s.pose, s.width, s.height);
  auto buffer = std::make_shared<DepthBuffer>(camera, s.volume.grid);
  for (std::int64_t row = 0; row < buffer->rows(); ++row)
    for (std::int64_t column = 0; column < buffer->columns(); ++column)
      buffer->set(buffer->sample(column, row),
                  camera.targetDepth() + buffer->position(column, row).dot(Vec2(0.5, -0.3)));
  return ClipDepth{camera,
                   buffer,
                   std::make_shared<const DepthPyramid>(*buffer),
                   ClipDepth::Lookup::linear,
                   {0.0, 3.0}};
}

/// Mean collision depth, times the fraction of rays that collide.
double meanDepth(double extinction, double length) {
  const double transmittance = std::exp(-extinction * length);
  return (1.0 - transmittance * (1.0 + extinction * length)) / extinction;
}

/// Root mean square of the differences, relative to that of `b`.
double relativeDifference(const Plane& a, const Plane& b) {
  double difference = 0.0, reference = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    difference += std::pow(static_cast<double>(a[i]) - static_cast<double>(b[i]), 2.0);
    reference += std::pow(static_cast<double>(b[i]), 2.0);
  }
  return std::sqrt(difference / reference);
}

TEST(FeatureBuffers, OfASlabHaveTheirClosedForm) {
  for (const double extinction : {1e-3, 0.05, 0.4, 3.0}) {
    const FeatureBuffers features = renderFeatures(makeSlab(extinction));
    const double hit = 1.0 - std::exp(-10.0 * extinction);
    const std::size_t middle = features.hit.size() / 2 + 8;
    EXPECT_NEAR(features.hit[middle], hit, 0.03 * hit) << extinction; // marching stops in the dark
    EXPECT_NEAR(features.depth[middle], 50.0 * hit + meanDepth(extinction, 10.0),
                0.04 * 60.0 * hit);
    EXPECT_NEAR(features.albedo[1][middle], 0.5 * features.hit[middle], 1e-5);
    EXPECT_EQ(features.normal[0][middle], 0.0F); // no gradient
  }
}

TEST(FeatureBuffers, HalfOfTheLightIsStoppedWhereTheTransmittanceIsAHalf) {
  for (const double extinction : {0.05, 0.4, 3.0, 40.0})
    makeSlab(extinction).visitView([&](const SceneView& scene) {
      const double inside = std::log(2.0) / extinction;
      for (const FeatureBuffers& features : {computeFeatures(scene), computeScalarFeatures(scene)})
        for (const std::size_t pixel : {std::size_t{0}, features.hit.size() / 2 + 8})
          if (inside > 10.0)
            EXPECT_EQ(features.depth50[pixel], infinity);
          else
            EXPECT_NEAR(features.depth50[pixel], 50.0 + inside, 0.005) << extinction;
    });
}

TEST(FeatureBuffers, EndSoonOnceStopped) {
  const StopFlag stop = true;
  makeWaves().visitView([&](const SceneView& scene) {
    const FeatureBuffers features = computeFeatures(scene, FeatureEffort::full, stop);
    EXPECT_EQ(features.hit, Plane(features.hit.size(), 0.0F));
  });
}

TEST(FeatureBuffers, DraftsDifferAtEdgesOnly) {
  makeWaves().visitView([&](const SceneView& scene) {
    const FeatureBuffers full = computeFeatures(scene);
    const FeatureBuffers draft = computeFeatures(scene, FeatureEffort::draft);
    EXPECT_EQ(draft.depth50, full.depth50);
    std::size_t equal = 0;
    for (std::size_t i = 0; i < full.hit.size(); ++i)
      equal += draft.hit[i] == full.hit[i] ? 1 : 0;
    EXPECT_GT(equal, full.hit.size() / 4);
    EXPECT_LT(equal, full.hit.size());
    EXPECT_LT(relativeDifference(draft.light, full.light), 0.5);
  });
}

TEST(FeatureBuffers, LightOfASlabHasItsClosedForm) {
  TestScene s = makeSlab(0.1);
  s.lights = {DirectionalLight{.direction = -Vec3::UnitX(), .irradiance = Rgb::Constant(2.0)}};
  const FeatureBuffers features = renderFeatures(s);
  const std::size_t middle = features.hit.size() / 2 + 8;
  const double depth = static_cast<double>(features.depth[middle] / features.hit[middle]) - 50.0;
  const double toFarSide = std::exp(-0.1 * (10.0 - depth)), phase = 1.0 / (4.0 * pi);
  EXPECT_NEAR(features.light[middle],
              0.5 * phase * 2.0 * static_cast<double>(features.hit[middle]) * toFarSide, 1e-3);
}

TEST(FeatureBuffers, AreZeroWhereRaysHitNothing) {
  TestScene s = makeSlab(0.0);
  s.pose.scale = 100.0;
  const FeatureBuffers features = renderFeatures(s);
  for (std::size_t i = 0; i < features.hit.size(); ++i) {
    EXPECT_EQ(features.hit[i], 0.0F);
    EXPECT_EQ(features.depth[i], 0.0F);
    EXPECT_EQ(features.surfaceNormal[2][i], 0.0F);
  }
}

/// On this axis half a voxel is below the rounding error of a float, which SIMD cannot march.
TEST(FeatureBuffers, TerminateOnAnAxisOfMoreThanHalfAMillionVoxels) {
  const Grid grid = makeCenteredGrid({2, 2, 600'000}, {1.0, 1.0, 1.0});
  TestScene s{makeVolume<std::uint8_t>(grid, [](const Vec3& p) { return p.z() < 3.0 ? 1 : 0; }),
              makeLinearTransfer(0.1, Rgb(0.9, 0.5, 0.1)),
              {DirectionalLight{}},
              {.position = {0, 0, 4e5}, .target = Vec3::Zero(), .up = Vec3::UnitY(), .scale = 1.5},
              4,
              4};
  s.visitView([](const SceneView& scene) {
    EXPECT_FALSE(canUseSimd(scene));
    EXPECT_GT(computeFeatures(scene).hit[5], 0.1F);
  });
}

/// depth50 with finite values only.
Plane boundDepth(const FeatureBuffers& features) {
  Plane depth = features.depth50;
  for (float& value : depth)
    value = std::min(value, 100.0F);
  return depth;
}

TEST(FeatureBuffers, SimdAgreesWithScalarMarching) {
  TestScene s = makeWaves();
  std::vector<Clip> clips = {ClipNone(), makeTiltedClip(s)};
  clips.push_back(
      ClipPlane{Camera(s.pose, s.width, s.height), Vec3(0, 2, 0), -Vec3::UnitY(), {0.0, 3.0}});
  clips.push_back(
      buildClippingSurface(
          Camera(s.pose, s.width, s.height), Domain(s.volume.grid),
          testing_clipping::makeMask(s.volume.grid, [](const Vec3& p) { return p.norm() < 5.0; }),
          {.boundary = Boundary::exact, .edge = {0.0, 0.5}})
          .clip);
  for (std::size_t i = 0; i < 2 * clips.size(); ++i) {
    s.clip = clips[i / 2];
    s.transfer.gradient = i % 2 == 0 ? GradientKind::central : GradientKind::sobel;
    s.visitView([](const SceneView& scene) {
      ASSERT_TRUE(canUseSimd(scene));
      const FeatureBuffers simd = computeFeatures(scene), scalar = computeScalarFeatures(scene);
      EXPECT_LT(relativeDifference(simd.hit, scalar.hit), 0.01);
      EXPECT_LT(relativeDifference(simd.depth, scalar.depth), 0.01);
      EXPECT_LT(relativeDifference(simd.light, scalar.light), 0.2);
      EXPECT_LT(relativeDifference(boundDepth(simd), boundDepth(scalar)), 0.01);
      for (std::size_t c = 0; c < 3; ++c) {
        EXPECT_LT(relativeDifference(simd.albedo[c], scalar.albedo[c]), 0.02);
        EXPECT_LT(relativeDifference(simd.normal[c], scalar.normal[c]), 0.2);
        EXPECT_LT(relativeDifference(simd.surfaceNormal[c], scalar.surfaceNormal[c]), 0.2);
      }
    });
  }
}

/// Nearly all collisions are in the soft clip edge; the medium alone has no surface.
TEST(FeatureBuffers, NormalsOfAHomogeneousMediumFollowTheSoftClipEdge) {
  for (const Projection projection : {Projection::orthographic, Projection::perspective}) {
    TestScene s = makeSlab(6.0);
    s.pose.projection = projection;
    s.transfer.shading = SurfaceShading{};
    s.clip = makeTiltedClip(s);
    const double opacity = 1.0 - std::exp(-6.0);
    // Surface probability (Kroes, Post, Botha 2012) at gamma 0.5.
    const double probability = opacity * (1.0 - std::exp(-25.0 * 0.125 * cutSlope));
    const std::size_t middle = static_cast<std::size_t>(s.width * s.height / 2 + s.width / 2);
    const Vec3 normal = -cutGradient(s.clip, Vec3(1.0, 0.0, 0.0)).normalized();
    s.visitView([&](const SceneView& scene) {
      for (const FeatureBuffers& features : {computeFeatures(scene), computeScalarFeatures(scene)})
        for (std::size_t c = 0; c < 3; ++c) {
          const double hit = static_cast<double>(features.hit[middle]);
          const double expected = normal[static_cast<int>(c)] * hit;
          EXPECT_NEAR(features.normal[c][middle], expected, 0.01) << c;
          EXPECT_NEAR(features.surfaceNormal[c][middle], expected * probability, 0.01) << c;
        }
    });
  }
}

TEST(FeatureBuffers, AreTheMeanOfTheSamples) {
  TestScene s = makeWaves();
  s.clip = makeTiltedClip(s);
  RenderSettings settings;
  settings.samples = 512;
  settings.path.wantNormals = true;
  settings.path.bounces = 1;
  const Film film = s.render(settings).film;
  const FeatureBuffers features = renderFeatures(s);
  std::array<Plane, 7> means; // albedo, normal, depth
  for (const PixelSums& pixel : film.pixels()) {
    const auto n = static_cast<double>(pixel.samples);
    means[6].push_back(static_cast<float>(pixel.depth / n));
    for (int c = 0; c < 3; ++c) {
      means[static_cast<std::size_t>(c)].push_back(static_cast<float>(pixel.albedo[c] / n));
      means[static_cast<std::size_t>(3 + c)].push_back(static_cast<float>(pixel.normal[c] / n));
    }
  }
  EXPECT_LT(relativeDifference(features.depth, means[6]), 0.05);
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_LT(relativeDifference(features.albedo[c], means[c]), 0.07) << c;
    EXPECT_LT(relativeDifference(features.normal[c], means[3 + c]), 0.2) << c;
  }
}

TEST(FeatureBuffers, CroppedImageEqualsTheSamePartOfTheCompleteImage) {
  TestScene s = makeWaves();
  s.width = s.height = 40;
  s.pose.scale = 10.0;
  const FeatureBuffers reference = renderFeatures(s);
  s.height = 20; // the middle rows
  s.pose.scale = 5.0;
  const FeatureBuffers cropped = renderFeatures(s);
  for (int row = 1; row < 19; ++row) // results depend on neighbors, which border rows lack
    for (int column = 0; column < 40; ++column)
      ASSERT_NEAR(cropped.depth[static_cast<std::size_t>(row * 40 + column)],
                  reference.depth[static_cast<std::size_t>((row + 10) * 40 + column)], 1e-3)
          << column << " " << row;
}

} // namespace
} // namespace fenestra::core::testing::FeatureBuffersTests
