#include "model/lights/LightSet.h"

#include "Histogram.h"

namespace fenestra::core::testing::LightSetTests {
namespace {

const Grid grid(Size3(10, 10, 10), Affine::Identity());

Camera makeCamera() {
  CameraPose pose;
  pose.position = {4.5, -50, 4.5};
  pose.target = {4.5, 4.5, 4.5};
  return {pose, 8, 8};
}

/// Map with rows of very different brightness, one black texel and one much brighter than the rest.
EnvironmentMap makeRoughMap() {
  EnvironmentMap map{12, 6, {}};
  for (int i = 0; i < 72; ++i) {
    Random random(9, static_cast<std::uint64_t>(i), 0);
    const float value = i == 17 ? 0.0F : i == 40 ? 20.0F : static_cast<float>(random.uniform());
    map.rgb.insert(map.rgb.end(), {value, 0.5F * value, 0.1F * value});
  }
  return map;
}

TEST(EnvironmentSampler, SamplingMatchesPdf) {
  const EnvironmentSampler sampler({Rgb::Ones(), makeRoughMap()});
  expectSamplingMatchesPdf([&](Random& r) { return sampler.sample(r.uniform2()); },
                           [&](const Vec3& d) { return sampler.pdf(d); }, 1.0, 120);
}

TEST(EnvironmentSampler, NeverSamplesABlackTexelAtTheLimitsOfTheRandomRange) {
  const EnvironmentSampler sampler({Rgb::Ones(), makeRoughMap()});
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
  const auto makeSampler = [&](int column, int row) {
    EnvironmentMap lit = map;
    lit.rgb[static_cast<std::size_t>(3 * (column + 4 * row))] = 1.0F;
    return EnvironmentSampler({Rgb::Ones(), lit});
  };
  // Columns 1 and 2 meet at anterior; right is a quarter turn to the right.
  EXPECT_EQ(makeSampler(2, 0).radiance(Vec3(0.1, 1, 0.5).normalized())[0], 1.0);
  EXPECT_EQ(makeSampler(1, 0).radiance(Vec3(-0.1, 1, 0.5).normalized())[0], 1.0);
  EXPECT_EQ(makeSampler(2, 1).radiance(Vec3(1, 0.1, -0.5).normalized())[0], 1.0);
  EXPECT_EQ(makeSampler(3, 1).radiance(Vec3(1, -0.1, -0.5).normalized())[0], 1.0);
}

/// Expects that LightSet::sample() follows the pdfs of sumEmitterHits() and evaluateEnvironment().
void expectConsistent(const std::vector<Light>& lights, const Vec3& point, int fine) {
  const LightSet set(lights, grid, makeCamera());
  const auto sampleDirection = [&](Random& r) -> Vec3 {
    const auto sample = set.sample(point, r);
    return sample && !sample->isDelta ? sample->direction : Vec3(Vec3::Zero());
  };
  const auto pdf = [&](const Vec3& d) {
    double density = set.evaluateEnvironment(d).pdf;
    set.sumEmitterHits({point, d}, infinity, [&](const EmitterHit& hit) {
      density += hit.pdf;
      return Rgb(Rgb::Zero());
    });
    return density;
  };
  double probability = 0.0;
  constexpr int n = 200000;
  for (int i = 0; i < n; ++i) {
    Random random(12, static_cast<std::uint64_t>(i), 0);
    probability += sampleDirection(random).squaredNorm() > 0.0 ? 1.0 / n : 0.0;
  }
  expectSamplingMatchesPdf(sampleDirection, pdf, probability, fine);
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
  map.map = makeRoughMap();
  EnvironmentLight black;
  black.map = {2, 1, std::vector<float>(6, 0.0F)};
  expectConsistent({constant, black, map, DirectionalLight{}}, {1, 2, 3}, 120);
}

TEST(LightSet, AreaLightsEmitFromOneSide) {
  AreaLight light;
  light.center = {0, 0, 10};
  light.normal = Vec3::UnitZ(); // away from the origin
  const LightSet set({light}, grid, makeCamera());
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
  const LightSet set({light}, grid, makeCamera());
  Random random(1, 1, 1);
  const auto sample = set.sample(grid.worldCenter(), random);
  ASSERT_TRUE(sample);
  EXPECT_NEAR(sample->distance, 3.0 * grid.boundingRadius(), 0.1 * grid.boundingRadius());
  EXPECT_LT(sample->direction.y(), -0.99) << "the camera is at negative y";
}

SphereLight makeBall(const Vec3& center, double diameter) {
  return {center, diameter, Rgb(2.0, 1.0, 0.5)};
}

TEST(LightSet, SamplingOfASphereMatchesPdf) {
  expectConsistent({makeBall({4, -3, 9}, 7)}, {4.5, 4.5, 4.5}, 300);
  expectConsistent({makeBall({4, 4, 6}, 7)}, {4.5, 4.5, 4.5}, 60); // from inside
  AreaLight disk;
  disk.shape = AreaLight::Shape::disk;
  disk.center = {-4, 5, 4};
  disk.normal = Vec3::UnitX();
  disk.size = {5, 5};
  expectConsistent({makeBall({4, -3, 9}, 7), disk, makeBall({4, 4, 6}, 7)}, {4.5, 4.5, 4.5}, 300);
}

/// Irradiance over pi from the set's one light at a point of a plane with this normal: the mean of
/// samples, and the integral over directions that hit the light.
std::array<double, 2> measureIrradiance(const LightSet& set, const Vec3& point,
                                        const Vec3& normal) {
  double sampled = 0.0;
  constexpr int n = 40000;
  for (int i = 0; i < n; ++i) {
    Random random(5, static_cast<std::uint64_t>(i), 0);
    const auto sample = set.sample(point, random);
    if (sample)
      sampled += sample->radiance[0] * std::max(0.0, normal.dot(sample->direction)) /
                 (sample->pdf * n * pi);
  }
  const auto integrand = [&](const Vec3& d) {
    const auto radiance = [](const EmitterHit& hit) { return hit.radiance; };
    return set.sumEmitterHits({point, d}, infinity, radiance)[0] * std::max(0.0, normal.dot(d));
  };
  double integrated = 0.0;
  for (const double part : integrateBins(integrand, 60))
    integrated += part / pi;
  return {sampled, integrated};
}

TEST(LightSet, SphereLightsAFacingPlaneByTheSquareOfRadiusOverDistance) {
  // E = pi L (r / d)^2 from outside, with the complete sphere visible; pi L from inside.
  const Vec3 toward = Vec3(2, -1, 2) / 3.0;
  const double radius = 3.0;
  for (const double distance : {0.0, 1.0, 2.999, 3.001, 4.0, 12.0}) {
    const LightSet set({makeBall(distance * toward, 2.0 * radius)}, grid, makeCamera());
    const auto [sampled, integrated] = measureIrradiance(set, Vec3::Zero(), toward);
    const double expected = 2.0 * std::pow(radius / std::max(radius, distance), 2.0);
    EXPECT_NEAR(sampled, expected, 0.02 * expected) << distance;
    EXPECT_NEAR(integrated, expected, 0.01 * expected) << distance;
  }
}

TEST(LightSet, SmallDistantAndNearSpheresKeepTheirPrecision) {
  const Vec3 toward = Vec3(1, 2, -2) / 3.0;
  const auto sampleBall = [&](double radius, double distance, const Vec2& u) {
    const LightSet set({makeBall(distance * toward, 2.0 * radius)}, grid, makeCamera());
    return set.sample(Vec3::Zero(), 0.0, u);
  };
  const auto far = sampleBall(1e-6, 1e6, {0.5, 0.5});
  ASSERT_TRUE(far);
  EXPECT_NEAR(far->pdf * pi * 1e-24, 1.0, 1e-12) << "1 over the solid angle";
  EXPECT_NEAR(far->distance, 1e6, 1e-6);
  EXPECT_NEAR(far->direction.dot(toward), 1.0, 1e-15);
  for (const double gap : {1e-9, -1e-9}) { // touching, from outside and inside
    const auto near = sampleBall(1.0, 1.0 + gap, {0.0, 0.5});
    ASSERT_TRUE(near);
    EXPECT_NEAR(near->distance, gap > 0.0 ? 1e-9 : 2.0, 1e-8);
    EXPECT_NEAR(near->pdf * 2.0 * pi, gap > 0.0 ? 1.0 : 0.5, 1e-4);
  }
  const auto center = sampleBall(1.0, 0.0, {0.3, 0.7});
  ASSERT_TRUE(center);
  EXPECT_NEAR(center->distance, 1.0, 1e-12);
}

TEST(LightSet, RayHitsASphereOnceAndOnlyAhead) {
  const LightSet set({makeBall({10, 0, 0}, 4)}, grid, makeCamera());
  const auto intersect = [&](const Vec3& from, const Vec3& direction, double end) {
    const auto radiance = [](const EmitterHit& hit) { return hit.radiance; };
    return set.sumEmitterHits({from, direction}, end, radiance)[0];
  };
  const Vec3 x = Vec3::UnitX();
  EXPECT_EQ(intersect({0, 1.99, 0}, x, infinity), 2.0);
  EXPECT_EQ(intersect({0, 2.01, 0}, x, infinity), 0.0);
  EXPECT_EQ(intersect({20, 0, 0}, x, infinity), 0.0) << "behind";
  EXPECT_EQ(intersect({0, 0, 0}, x, 7.9), 0.0) << "too far";
  EXPECT_EQ(intersect({0, 0, 0}, x, 8.1), 2.0);
  EXPECT_EQ(intersect({11, 0, 0}, x, 1.1), 2.0) << "from inside";
  EXPECT_EQ(intersect({11, 0, 0}, x, 0.9), 0.0);
  EXPECT_EQ(intersect({11, 0, 0}, -x, 2.9), 0.0);
  EXPECT_EQ(intersect({11, 0, 0}, -x, 3.1), 2.0);
}

TEST(LightSet, FocusFrameIsTheWorldCenteredAtTheFocus) {
  SphereLight sphere = makeBall({0, 0, 20}, 0.01);
  sphere.frame = LightFrame::focus;
  AreaLight disk;
  disk.shape = AreaLight::Shape::disk;
  disk.center = {0, 0, 20};
  disk.normal = -Vec3::UnitZ();
  disk.size = {0.01, 0.01};
  disk.frame = LightFrame::focus;
  for (const Light& light : {Light(sphere), Light(disk)}) {
    const LightSet set({light}, grid, makeCamera(), {1, 2, 3});
    const auto sample = set.sample({1, 2, 3}, 0.0, {0.5, 0.5});
    ASSERT_TRUE(sample);
    EXPECT_NEAR(sample->distance, 20.0, 0.02);
    EXPECT_NEAR(sample->direction.z(), 1.0, 1e-6);
  }
}

/// Irradiance over pi from the environment on a plane with this normal.
Rgb measureSkyIrradiance(const LightSet& set, const Vec3& normal) {
  Rgb sum = Rgb::Zero();
  for (int channel = 0; channel < 3; ++channel) {
    const auto integrand = [&](const Vec3& d) {
      return set.evaluateEnvironment(d).radiance[channel] * std::max(0.0, normal.dot(d));
    };
    for (const double part : integrateBins(integrand, 16))
      sum[channel] += part / pi;
  }
  return sum;
}

TEST(LightSet, SkyIrradianceIsTwoThirdsOfItsEndPlusOneThirdOfItsMiddle) {
  // E / pi = 2 int_0^1 (middle + (top - middle) t) t dt
  const Vec3 up = Vec3(1, 2, -2) / 3.0;
  SkyLight sky{Rgb(3, 2, 1), Rgb(0.3, 0.6, 0.9), Rgb(0, 0.5, 4), up, LightFrame::world};
  const LightSet set({sky}, grid, makeCamera());
  EXPECT_LT((measureSkyIrradiance(set, up) - (2 * sky.top + sky.middle) / 3).abs().maxCoeff(),
            2e-3);
  EXPECT_LT((measureSkyIrradiance(set, -up) - (2 * sky.bottom + sky.middle) / 3).abs().maxCoeff(),
            2e-3);
  EXPECT_EQ(set.evaluateEnvironment(up).pdf, 0.0) << "skies are never sampled";
  Random random(1, 1, 1);
  EXPECT_FALSE(set.sample(Vec3::Zero(), random));
}

TEST(LightSet, SkyOfTheCameraFrameRotatesWithTheCamera) {
  SkyLight sky;
  sky.bottom = Rgb::Zero();
  sky.middle = Rgb::Constant(0.5);
  const LightSet up({sky}, grid, makeCamera());
  EXPECT_NEAR(up.evaluateEnvironment(Vec3::UnitZ()).radiance[0], 1.0, 1e-12) << "the camera's up";
  EXPECT_NEAR(up.evaluateEnvironment(-Vec3::UnitZ()).radiance[0], 0.0, 1e-12);
  sky.up = Vec3::UnitZ();
  const LightSet toViewer({sky}, grid, makeCamera());
  EXPECT_NEAR(toViewer.evaluateEnvironment(-Vec3::UnitY()).radiance[0], 1.0, 1e-12);
  EXPECT_NEAR(toViewer.evaluateEnvironment(Vec3::UnitX()).radiance[0], 0.5, 1e-12);
}

TEST(LightSet, WithoutLightsNothingIsSampled) {
  const LightSet set({}, grid, makeCamera());
  Random random(1, 1, 1);
  EXPECT_FALSE(set.sample(Vec3::Zero(), random));
  EXPECT_EQ(set.evaluateEnvironment(Vec3::UnitX()).pdf, 0.0);
}

} // namespace
} // namespace fenestra::core::testing::LightSetTests
