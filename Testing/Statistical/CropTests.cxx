// Cropping, against closed forms and against a volume of the crop's shape.

#include "Support.h"

#include <gtest/gtest.h>

namespace fenestra::core::testing::CropTests {
namespace {

Volume makeUniformVolume(const Grid& grid) {
  return makeVolume(grid, [](const Vec3&) { return 1.0; });
}

/// Map of [-1, 1]^3 onto a rotated box of half edges `half` around `center`.
Affine makeRotatedBox(const Vec3& center, const Vec3& half, double angle) {
  return makeTranslation(center) * makeRotation(angle, Vec3(1.0, -2.0, 0.5).normalized()) *
         makeScaling(half);
}

/// Length of a ray, t >= 0, inside a parallelepiped, by intersection of its six half-spaces.
double chord(const Affine& box, const Ray& ray) {
  double begin = 0.0;
  double end = infinity;
  const Vec3 center = box.translation();
  for (int axis = 0; axis < 3; ++axis) {
    const Vec3 edge = box.linear().col(axis);
    const Vec3 normal =
        box.linear().col((axis + 1) % 3).cross(box.linear().col((axis + 2) % 3)).normalized();
    for (const double side : {-1.0, 1.0}) {
      const Vec3 outward = side * (normal.dot(edge) > 0.0 ? normal : -normal);
      const double height = outward.dot(ray.origin - center - side * edge);
      const double slope = outward.dot(ray.direction);
      (slope > 0.0 ? end : begin) =
          slope > 0.0 ? std::min(end, -height / slope) : std::max(begin, -height / slope);
    }
  }
  return std::max(0.0, end - begin);
}

/// Sum of differences from expectations, and its variance.
struct Differences {
  double sum = 0.0, variance = 0.0;

  void addDifference(double estimate, double expected) {
    sum += estimate - expected;
    variance += (estimate - expected) * (estimate - expected);
  }
  double z() const { return sum / std::sqrt(variance); }
};

class CroppedTransmittance : public ::testing::TestWithParam<bool> {};

TEST_P(CroppedTransmittance, IsExponentialAlongTheChord) {
  const Volume volume = makeUniformVolume(makeCenteredGrid({30, 30, 30}, {1.0, 1.0, 1.0}));
  const double sigma_t = 0.2;
  const TransferFunction transfer = makeLinearTransfer(sigma_t, Rgb::Zero());
  const TransferFunction looser = transfer.withDensity(2.0); // adds null collisions
  Affine box = makeRotatedBox({0.3, -0.4, 0.2}, {3.0, 5.0, 4.0}, 0.7);
  if (GetParam()) // sheared, as by a parent transform of the box
    box = Affine(Mat3::FromRows({1.0, 0.3, 0.0}, {0.0, 1.0, -0.2}, {0.1, 0.0, 0.8})) * box;
  const MajorantGrid majorants(volume.grid, MinMaxGrid(volume, 0), looser, ClipNone{});
  const Medium<float> medium(volume.grid, std::get<LargeArray<float>>(volume.voxels), transfer);
  const Clip clip;
  const Tracker<float> tracker(Domain(volume.grid, CropBox(box)), medium, majorants, clip);
  Counters counters;
  Differences passed, survived;
  for (std::uint64_t i = 0; i < 200000; ++i) {
    Random random(31, i, 0);
    // Origins outside the volume, between the boxes, and inside the crop.
    const double distance = i % 3 == 0 ? 40.0 : i % 3 == 1 ? 9.0 : 2.0;
    const Vec3 origin = distance * sampleUniformSphere(random.uniform2());
    const Vec3 through = 4.0 * sampleUniformSphere(random.uniform2());
    const Ray ray{origin, (through - origin).normalized()};
    const double expected = std::exp(-sigma_t * chord(box, ray));
    passed.addDifference(tracker.transmittance(ray, {}, random, counters), expected);
    const bool free =
        tracker.sampleCollision(ray, {}, random.uniform2(), random, counters) == infinity;
    survived.addDifference(free ? 1.0 : 0.0, expected);
  }
  EXPECT_NEAR(passed.z(), 0.0, 4.0);
  EXPECT_NEAR(survived.z(), 0.0, 4.0);
}

INSTANTIATE_TEST_SUITE_P(Boxes, CroppedTransmittance, ::testing::Bool());

struct Shape {
  const char* name;
  double angle;
  Projection projection;
};

class CroppedImage : public ::testing::TestWithParam<Shape> {};

TestScene makeLitScene(Volume volume, const Shape& shape) {
  TestScene scene{std::move(volume),
                  makeLinearTransfer(0.5, Rgb(0.9, 0.8, 0.7), 0.3),
                  {EnvironmentLight{.radiance = Rgb::Constant(0.3), .map = {}},
                   DirectionalLight{.direction = {0.3, 1.0, -0.5}}},
                  {},
                  24,
                  24};
  scene.pose.projection = shape.projection;
  scene.pose.position = {8.0, -40.0, 12.0};
  scene.pose.target = {1.0, 0.0, -1.0};
  scene.pose.scale = 8.0;
  scene.pose.angle = 20.0;
  return scene;
}

/// Camera rays, scattered rays and shadow rays all end at the crop: a box cropped from a larger
/// constant volume looks like a volume of that shape, at any rotation relative to the voxels.
TEST_P(CroppedImage, EqualsImageOfVolumeOfThatShape) {
  const Vec3 half(5.0, 4.0, 3.0);
  const Affine box = makeRotatedBox({1.0, 0.0, -1.0}, half, GetParam().angle);
  // Grid of 10 x 8 x 6 voxels of 1 mm that fills the box.
  const Affine indexToWorld =
      box * makeScaling(Vec3(half.cwiseInverse())) * makeTranslation(Vec3(-4.5, -3.5, -2.5));
  const TestScene cut = makeLitScene(makeUniformVolume(Grid({10, 8, 6}, indexToWorld)), GetParam());
  TestScene cropped =
      makeLitScene(makeUniformVolume(makeCenteredGrid({24, 24, 24}, {1.0, 1.0, 1.0})), GetParam());
  cropped.crop = CropBox(box);

  RenderSettings settings;
  settings.samples = 400;
  settings.seed = 1;
  const Film a = cut.render(settings).film;
  settings.seed = 2;
  const Film b = cropped.render(settings).film;
  double chiSquared = 0.0;
  double count = 0.0;
  Differences all;
  for (std::size_t i = 0; i < a.pixelCount(); ++i) {
    const double variance =
        a.pixels()[i].standardError().square()[1] + b.pixels()[i].standardError().square()[1];
    const double difference = a.pixels()[i].mean[1] - b.pixels()[i].mean[1];
    EXPECT_EQ(variance == 0.0, difference == 0.0) << "rays outside the box hit nothing";
    if (variance == 0.0)
      continue;
    chiSquared += difference * difference / variance;
    count += 1.0;
    all.sum += difference;
    all.variance += variance;
  }
  EXPECT_GT(count, 200.0);
  EXPECT_LT(count, 500.0) << "some pixels must be outside the box";
  // Pixels of few colliding paths are far from normal: their chi-squared varies more.
  EXPECT_NEAR(chiSquared, count, 6.0 * std::sqrt(2.0 * count));
  EXPECT_NEAR(all.z(), 0.0, 4.0);
}

INSTANTIATE_TEST_SUITE_P(Shapes, CroppedImage,
                         ::testing::Values(Shape{"upright", 0.0, Projection::orthographic},
                                           Shape{"rotated", 0.6, Projection::orthographic},
                                           Shape{"perspective", 1.1, Projection::perspective}),
                         [](const auto& info) { return std::string(info.param.name); });

} // namespace
} // namespace fenestra::core::testing::CropTests
