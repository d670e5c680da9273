#include "model/lights/LightSet.h"

#include "Histogram.h"

namespace fenestra::testing::LightSetTests {
namespace {

const Grid grid(Size3(10, 10, 10), Affine::Identity());

Camera camera() {
  CameraPose pose;
  pose.position = {4.5, -50, 4.5};
  pose.target = {4.5, 4.5, 4.5};
  return {pose, 8, 8};
}

/// Map with rows of very different brightness, one black texel, one far brighter than the rest.
EnvironmentMap roughMap() {
  EnvironmentMap map{12, 6, {}};
  for (int i = 0; i < 72; ++i) {
    Random random(9, static_cast<std::uint64_t>(i), 0);
    const float value = i == 17 ? 0.0F : i == 40 ? 20.0F : static_cast<float>(random.uniform());
    map.rgb.insert(map.rgb.end(), {value, 0.5F * value, 0.1F * value});
  }
  return map;
}

TEST(EnvironmentSampler, SamplingMatchesPdf) {
  const EnvironmentSampler sampler({Rgb::Ones(), roughMap()});
  expectSamplingMatchesPdf([&](Random& r) { return sampler.sample(r.uniform2()); },
                           [&](const Vec3& d) { return sampler.pdf(d); }, 1.0, 120);
}

TEST(EnvironmentSampler, NeverDrawsABlackTexelAtTheEndsOfTheRandomRange) {
  const EnvironmentSampler sampler({Rgb::Ones(), roughMap()});
  const double last = std::nextafter(1.0, 0.0);
  for (const double u : {0.0, 0.5, last})
    for (const double v : {0.0, 0.5, last}) {
      const Vec3 d = sampler.sample({u, v});
      EXPECT_NEAR(d.norm(), 1.0, 1e-12);
      EXPECT_GT(sampler.pdf(d), 0.0);
    }
}

TEST(EnvironmentSampler, ColumnsLieAroundAnteriorAndRight) {
  EnvironmentMap map{4, 2, std::vector<float>(24, 0.0F)};
  const auto light = [&](int column, int row) {
    EnvironmentMap lit = map;
    lit.rgb[static_cast<std::size_t>(3 * (column + 4 * row))] = 1.0F;
    return EnvironmentSampler({Rgb::Ones(), lit});
  };
  // Columns 1 and 2 meet at anterior; right is a quarter turn to the right.
  EXPECT_EQ(light(2, 0).radiance(Vec3(0.1, 1, 0.5).normalized())[0], 1.0);
  EXPECT_EQ(light(1, 0).radiance(Vec3(-0.1, 1, 0.5).normalized())[0], 1.0);
  EXPECT_EQ(light(2, 1).radiance(Vec3(1, 0.1, -0.5).normalized())[0], 1.0);
  EXPECT_EQ(light(3, 1).radiance(Vec3(1, -0.1, -0.5).normalized())[0], 1.0);
}

/// Expects LightSet::sample() to draw directions by the pdfs of areaArrivals() and environment().
void expectConsistent(const std::vector<Light>& lights, const Vec3& point, int fine) {
  const LightSet set(lights, grid, camera());
  const auto draw = [&](Random& r) -> Vec3 {
    const auto sample = set.sample(point, r);
    return sample && !sample->delta ? sample->direction : Vec3(Vec3::Zero());
  };
  const auto pdf = [&](const Vec3& d) {
    double density = set.environment(d).pdf;
    set.areaArrivals({point, d}, infinity, [&](const LightArrival& arrival) {
      density += arrival.pdf;
      return Rgb(Rgb::Zero());
    });
    return density;
  };
  double drawn = 0.0;
  constexpr int n = 200000;
  for (int i = 0; i < n; ++i) {
    Random random(12, static_cast<std::uint64_t>(i), 0);
    drawn += draw(random).squaredNorm() > 0.0 ? 1.0 / n : 0.0;
  }
  expectSamplingMatchesPdf(draw, pdf, drawn, fine);
}

TEST(LightSet, SamplingOfRectangleAndDiskMatchesPdf) {
  AreaLight rectangle;
  rectangle.center = {4, -3, 9};
  rectangle.normal = Vec3(0, 0.5, -1).normalized();
  rectangle.up = {1, 0.2, 0};
  rectangle.size = {6, 3};
  AreaLight disk;
  disk.shape = AreaLight::Shape::disk;
  disk.center = {-4, 5, 4};
  disk.normal = Vec3::UnitX();
  disk.size = {5, 5};
  expectConsistent({rectangle, disk}, {4.5, 4.5, 4.5}, 300);
}

TEST(LightSet, SamplingOfSeveralLightsMatchesPdf) {
  EnvironmentLight constant;
  constant.radiance = Rgb::Constant(0.3);
  EnvironmentLight map;
  map.map = roughMap();
  expectConsistent({constant, map, DirectionalLight{}}, {1, 2, 3}, 120);
}

TEST(LightSet, AreaLightsShineFromOneSide) {
  AreaLight light;
  light.center = {0, 0, 10};
  light.normal = Vec3::UnitZ(); // away from the origin
  const LightSet set({light}, grid, camera());
  Random random(1, 1, 1);
  EXPECT_FALSE(set.sample(Vec3::Zero(), random));
  EXPECT_TRUE(set.sample({0, 0, 20}, random));
}

TEST(LightSet, CameraFrameIsRightUpAndTowardTheViewer) {
  AreaLight light;
  light.frame = LightFrame::camera;
  light.center = {0, 0, 3};
  light.normal = -Vec3::UnitZ();
  light.size = {0.1, 0.1};
  const LightSet set({light}, grid, camera());
  Random random(1, 1, 1);
  const auto sample = set.sample(grid.worldCenter(), random);
  ASSERT_TRUE(sample);
  EXPECT_NEAR(sample->distance, 3.0 * grid.boundingRadius(), 0.1 * grid.boundingRadius());
  EXPECT_LT(sample->direction.y(), -0.99) << "the viewer stands at negative y";
}

/// Irradiance that arrives from all around on a plane with that normal, over pi.
Rgb receivedFromAround(const LightSet& set, const Vec3& normal) {
  Rgb sum = Rgb::Zero();
  for (int channel = 0; channel < 3; ++channel) {
    const auto arriving = [&](const Vec3& d) {
      return set.environment(d).radiance[channel] * std::max(0.0, normal.dot(d));
    };
    for (const double part : binIntegrals(arriving, 16))
      sum[channel] += part / pi;
  }
  return sum;
}

TEST(LightSet, SkyLightsAPlaneByTwoThirdsOfItsEndAndOneThirdOfItsMiddle) {
  // E / pi = 2 int_0^1 (middle + (top - middle) t) t dt
  const Vec3 up = Vec3(1, 2, -2) / 3.0;
  SkyLight sky{Rgb(3, 2, 1), Rgb(0.3, 0.6, 0.9), Rgb(0, 0.5, 4), up, LightFrame::world};
  const LightSet set({sky}, grid, camera());
  EXPECT_LT((receivedFromAround(set, up) - (2 * sky.top + sky.middle) / 3).abs().maxCoeff(), 2e-3);
  EXPECT_LT((receivedFromAround(set, -up) - (2 * sky.bottom + sky.middle) / 3).abs().maxCoeff(),
            2e-3);
  EXPECT_EQ(set.environment(up).pdf, 0.0) << "never sampled";
  Random random(1, 1, 1);
  EXPECT_FALSE(set.sample(Vec3::Zero(), random));
}

TEST(LightSet, SkyOfTheCameraTurnsWithTheCamera) {
  SkyLight sky;
  sky.bottom = Rgb::Zero();
  sky.middle = Rgb::Constant(0.5);
  const LightSet up({sky}, grid, camera());
  EXPECT_NEAR(up.environment(Vec3::UnitZ()).radiance[0], 1.0, 1e-12) << "the camera's up";
  EXPECT_NEAR(up.environment(-Vec3::UnitZ()).radiance[0], 0.0, 1e-12);
  sky.up = Vec3::UnitZ();
  const LightSet toViewer({sky}, grid, camera());
  EXPECT_NEAR(toViewer.environment(-Vec3::UnitY()).radiance[0], 1.0, 1e-12);
  EXPECT_NEAR(toViewer.environment(Vec3::UnitX()).radiance[0], 0.5, 1e-12);
}

TEST(LightSet, WithoutLightsNothingIsDrawn) {
  const LightSet set({}, grid, camera());
  Random random(1, 1, 1);
  EXPECT_FALSE(set.sample(Vec3::Zero(), random));
  EXPECT_EQ(set.environment(Vec3::UnitX()).pdf, 0.0);
}

} // namespace
} // namespace fenestra::testing::LightSetTests
