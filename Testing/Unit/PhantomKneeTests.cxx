#include "base/Error.h"
#include "model/medium/TransferFunction.h"
#include "phantoms/KneeBones.h"
#include "phantoms/KneeSignal.h"
#include "phantoms/Phantoms.h"

#include "Approx.h"
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <map>

namespace fenestra::core::PhantomKneeTests {
namespace {

const Phantom& smallKnee() {
  static const Phantom knee = makeKneePhantom({100, 115, 64});
  return knee;
}

const LargeArray<std::int16_t>& getVoxels(const Phantom& phantom) {
  return std::get<LargeArray<std::int16_t>>(phantom.volume.voxels);
}

const std::vector<std::uint8_t>& getLabels(const Phantom& phantom) {
  return phantom.labels.layers.at(0);
}

std::uint8_t findLabel(const Phantom& phantom, const std::string& id) {
  for (const PhantomSegment& segment : phantom.segments)
    if (segment.id == id)
      return segment.label;
  ADD_FAILURE() << "no segment " << id;
  return 0;
}

double computeMedian(const Phantom& phantom, const std::string& id) {
  const std::uint8_t label = findLabel(phantom, id);
  std::vector<std::int16_t> values;
  for (std::size_t i = 0; i < getLabels(phantom).size(); ++i)
    if (getLabels(phantom)[i] == label)
      values.push_back(getVoxels(phantom)[i]);
  if (values.empty())
    return 0.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Thickness of the cartilage along the bone's normal, mm.
double measureThickness(const KneeBones& bones, const Vec3& surface) {
  constexpr double h = 0.05;
  const Vec3 normal =
      Vec3(bones.femur(surface + Vec3(h, 0, 0)) - bones.femur(surface - Vec3(h, 0, 0)),
           bones.femur(surface + Vec3(0, h, 0)) - bones.femur(surface - Vec3(0, h, 0)),
           bones.femur(surface + Vec3(0, 0, h)) - bones.femur(surface - Vec3(0, 0, h)))
          .normalized();
  double t = 0.0;
  while (t < 5.0) {
    const Vec3 p = surface + (t + h) * normal;
    if (bones.femur(p) >= bones.femoralCartilage(p))
      break;
    t += h;
  }
  return t;
}

double measureThickness(const KneeBones& bones, double x, double angle) {
  return measureThickness(bones, bones.femoralSurface(x, angle));
}

} // namespace

TEST(PhantomKnee, EverySegmentHasVoxelsAndUniqueName) {
  const Phantom& knee = smallKnee();
  std::map<int, std::int64_t> count;
  for (const std::uint8_t label : getLabels(knee))
    ++count[label];
  std::map<std::string, int> names;
  for (std::size_t i = 0; i < knee.segments.size(); ++i) {
    EXPECT_EQ(knee.segments[i].label, i + 1);
    EXPECT_GT(count[knee.segments[i].label], 20) << knee.segments[i].name;
    EXPECT_EQ(++names[knee.segments[i].id], 1);
    EXPECT_EQ(++names["name " + knee.segments[i].name], 1);
  }
  EXPECT_EQ(count.rbegin()->first, static_cast<int>(knee.segments.size()));
  EXPECT_GT(count[0], knee.volume.grid.voxelCount() / 10) << "air";
}

TEST(PhantomKnee, IsReproducibleWithAnyNumberOfThreads) {
  const Size3 size(24, 28, 24);
  const Phantom many = makeKneePhantom(size);
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const Phantom single = makeKneePhantom(size);
  EXPECT_EQ(getVoxels(many), getVoxels(single));
  EXPECT_EQ(getLabels(many), getLabels(single));
}

TEST(PhantomKnee, PositionIsIndependentOfSize) {
  for (const Size3& size : {Size3(300, 344, 120), Size3(30, 43, 20)}) {
    const Grid grid = makeKneePhantom(size.cwiseMin(24)).volume.grid;
    EXPECT_TRUE(
        isApprox(grid.spacing().cwiseProduct(grid.size.cast<double>()), Vec3(120, 137.6, 120)));
    EXPECT_TRUE(isApprox(grid.worldCenter(), Vec3(0, -2, 6.8)));
  }
  const Mat3 axes = smallKnee().volume.grid.indexToWorld.linear().normalizedColumns();
  EXPECT_TRUE(isApprox(axes.col(0), Vec3(0, -1, 0))) << "posterior";
  EXPECT_TRUE(isApprox(axes.col(1), Vec3(0, 0, -1))) << "inferior";
  EXPECT_TRUE(isApprox(axes.col(2), Vec3(1, 0, 0))) << "right";
}

TEST(PhantomKnee, RefusesSizesOutOfRange) {
  EXPECT_THROW(makeKneePhantom({8, 100, 100}), Error);
  EXPECT_THROW(makeKneePhantom({100, 100, 4000}), Error);
}

TEST(PhantomKnee, HasAdultProportions) {
  const KneeBones bones;
  const auto extent = [&](auto distance, const Vec3& from, const Vec3& to) {
    int inside = 0;
    constexpr int steps = 4000;
    for (int i = 0; i < steps; ++i)
      inside += distance(from + (to - from) * (i + 0.5) / steps) < 0.0;
    return (to - from).norm() * inside / steps;
  };
  const auto femur = [&](const Vec3& p) { return bones.femur(p); };
  const auto tibia = [&](const Vec3& p) { return bones.tibia(p); };
  const auto patella = [&](const Vec3& p) { return bones.patella(p); };
  EXPECT_NEAR(extent(femur, {-60, -3, 25}, {60, -3, 25}), 80.0, 4.0) << "bicondylar width";
  EXPECT_NEAR(extent(femur, {22, -50, 25}, {22, 50, 25}), 62.0, 5.0) << "lateral condyle's depth";
  EXPECT_NEAR(extent(femur, {-60, -20, 12}, {0, -20, 12}), 26.0, 4.0) << "medial condyle's width";
  EXPECT_NEAR(extent(tibia, {-60, -4, -8}, {60, -4, -8}), 76.0, 4.0) << "plateau's width";
  EXPECT_NEAR(extent(patella, {-30, 42, 42}, {30, 42, 42}), 44.0, 3.0) << "patella's width";
  EXPECT_NEAR(extent(patella, {2, 42, 0}, {2, 42, 80}), 43.0, 4.0) << "patella's height";
  EXPECT_NEAR(extent(patella, {2, 20, 42}, {2, 60, 42}), 18.5, 2.5) << "patella's thickness";
}

TEST(PhantomKnee, FemoralCartilageHasAnatomicalThickness) {
  const KneeBones bones;
  double sum = 0.0, thinnest = infinity, thickest = 0.0;
  int count = 0;
  for (const double x : {-24.0, -20.0, 18.0, 24.0})
    for (double angle = -2.2; angle < -0.1; angle += 0.1) {
      const Vec3 surface = bones.femoralSurface(x, angle);
      const double intact = bones.intactFemoralCartilage(surface);
      if (bones.femoralCartilage(surface) < intact)
        continue; // a lesion
      const double thickness = measureThickness(bones, surface);
      sum += thickness;
      thinnest = std::min(thinnest, thickness);
      thickest = std::max(thickest, thickness);
      ++count;
    }
  ASSERT_GT(count, 60);
  EXPECT_GE(thinnest, 1.2);
  EXPECT_LE(thickest, 2.8);
  EXPECT_GT(sum / count, 1.6);
  EXPECT_LT(sum / count, 2.6);
  EXPECT_GT(thickest - thinnest, 0.5) << "the thickness must vary";
}

TEST(PhantomKnee, OneLesionReachesBoneAndOneReachesHalfDepth) {
  const KneeBones bones;
  const auto width = [&](const CartilageLesion& lesion) {
    int missing = 0;
    for (double x = -12.0; x < 12.0; x += 0.1) {
      const Vec3 p = bones.femoralSurface(lesion.x + x, lesion.angle);
      missing +=
          bones.femoralCartilage(p) < (1.0 - 0.5 * lesion.depth) * bones.intactFemoralCartilage(p);
    }
    return 0.1 * missing;
  };
  EXPECT_EQ(measureThickness(bones, fullThicknessLesion.x, fullThicknessLesion.angle), 0.0);
  EXPECT_NEAR(width(fullThicknessLesion), 8.0, 1.2);

  const Vec3 floor = bones.femoralSurface(partialThicknessLesion.x, partialThicknessLesion.angle);
  EXPECT_NEAR(measureThickness(bones, floor) / bones.intactFemoralCartilage(floor), 0.5, 0.1);
  EXPECT_NEAR(width(partialThicknessLesion), 9.0, 1.2);
}

TEST(PhantomKnee, LesionsFaceInferiorAndAnterior) {
  const KneeBones bones;
  for (const CartilageLesion& lesion : {fullThicknessLesion, partialThicknessLesion}) {
    const Vec3 p = bones.femoralSurface(lesion.x, lesion.angle);
    const double h = 0.5;
    const Vec3 normal(0.0, bones.femur(p + Vec3(0, h, 0)) - bones.femur(p - Vec3(0, h, 0)),
                      bones.femur(p + Vec3(0, 0, h)) - bones.femur(p - Vec3(0, 0, h)));
    EXPECT_GT(normal.normalized().dot(Vec3(0, 1, -1).normalized()), 0.85) << "inferior-anterior";
  }
}

// If anterior rays met posterior cartilage first, an anterior view would be clipped down to the
// rear of the condyles, beside the trochlea and behind the lesion.
TEST(PhantomKnee, AnteriorRaysMeetAnteriorCartilage) {
  const Phantom& knee = smallKnee();
  const std::uint8_t label = findLabel(knee, "FemoralCartilage");
  const Grid& grid = knee.volume.grid;
  int columns = 0;
  for (std::int64_t row = 0; row < grid.size.y() * grid.size.z(); ++row) {
    const auto begin = getLabels(knee).begin() + row * grid.size.x(); // from anterior to posterior
    const auto end = begin + grid.size.x();
    const auto first = std::find(begin, end, label);
    if (first == end)
      continue;
    ++columns;
    const Vec3 index(static_cast<double>(first - begin), 0.0, 0.0);
    EXPECT_GT((grid.indexToWorld * index).y(), -8.0) << "in row " << row;
  }
  EXPECT_GT(columns, 500);
}

TEST(PhantomKnee, MedianSignalsMatchT1) {
  const Phantom& knee = smallKnee();
  EXPECT_NEAR(computeMedian(knee, "MedialGastrocnemius"), 350.0, 45.0);
  EXPECT_NEAR(computeMedian(knee, "SubcutaneousFat"), 850.0, 80.0);
  EXPECT_NEAR(computeMedian(knee, "Femur"), 820.0, 70.0);
  EXPECT_NEAR(computeMedian(knee, "FemoralCartilage"), 510.0, 60.0);
  EXPECT_LT(computeMedian(knee, "MedialMeniscus"), 200.0);
  EXPECT_LT(computeMedian(knee, "PCL"), 200.0);
  const double snr = muscleSignal({-20, -45, -30}) / noiseSigma;
  EXPECT_GT(snr, 25.0);
  EXPECT_LT(snr, 40.0);
}

TEST(PhantomKnee, BiasFieldStaysWithinFifteenPercent) {
  for (double x = -60; x <= 60; x += 4)
    for (double y = -62; y <= 58; y += 4)
      for (double z = -62; z <= 76; z += 4)
        EXPECT_NEAR(biasField({x, y, z}), 1.0, 0.15);
}

TEST(PhantomKnee, CartilageIsDenseAndAirTransparent) {
  const TransferFunction transfer = tabulate(smallKnee().property, "knee");
  const auto sigma = [&](double s) { return transfer.extinction(s).value(); };
  EXPECT_EQ(sigma(14.0), 0.0); // the mean of noise in air
  EXPECT_EQ(sigma(44.0), 0.0); // four standard deviations
  EXPECT_GT(sigma(66.0), 0.2) << "cortex";
  EXPECT_GT(sigma(520.0), 3.0 * sigma(350.0)) << "muscle";
  EXPECT_GT(sigma(520.0), 3.0 * sigma(850.0)) << "fat";
  const Rgb cartilage = transfer.albedo(520.0), fat = transfer.albedo(850.0);
  EXPECT_GE(cartilage.z(), cartilage.x()) << "bluish white";
  EXPECT_LT(fat.z(), 0.5 * fat.x()) << "yellow";
}

} // namespace fenestra::core::PhantomKneeTests
