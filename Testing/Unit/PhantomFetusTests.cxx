// Synthetic fetus: contents of its segments, occlusion of the face, and reproducibility.

#include "base/Error.h"
#include "phantoms/Phantoms.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

namespace fenestra::core::PhantomFetusTests {
namespace {

const Phantom& smallFetus() {
  static const Phantom fetus = makeFetusPhantom({64, 64, 64});
  return fetus;
}

const LargeArray<std::int16_t>& getVoxels(const Phantom& phantom) {
  return std::get<LargeArray<std::int16_t>>(phantom.volume.voxels);
}

std::size_t countVoxels(int label) {
  const auto& labels = smallFetus().labels.layers.front();
  return static_cast<std::size_t>(std::count(labels.begin(), labels.end(), label));
}

TEST(PhantomFetus, ValuesAreEightBit) {
  const auto& voxels = getVoxels(smallFetus());
  EXPECT_GE(*std::min_element(voxels.begin(), voxels.end()), 0);
  EXPECT_LE(*std::max_element(voxels.begin(), voxels.end()), 255);
  EXPECT_GT(*std::max_element(voxels.begin(), voxels.end()), 150);
}

/// The head is roughly an ellipsoid with semi-axes 35, 43 and 36 mm, plus face, jaw and neck.
TEST(PhantomFetus, SegmentsHaveAnatomicalVolumes) {
  const double voxel = std::pow(112.0 / 64.0, 3.0) / 1000.0; // ml
  ASSERT_EQ(smallFetus().segments.size(), 3u);
  const double head = voxel * static_cast<double>(countVoxels(1));
  EXPECT_GT(head, 220.0);
  EXPECT_LT(head, 420.0);
  for (const int label : {2, 3})
    EXPECT_GT(countVoxels(label), 100u) << label;
  EXPECT_GT(countVoxels(0), countVoxels(1) / 2); // amniotic fluid
}

/// A ray from the front to any part of the face meets the uterine wall first.
TEST(PhantomFetus, WallOccludesFace) {
  const Phantom& fetus = smallFetus();
  const auto& labels = fetus.labels.layers.front();
  const Size3& size = fetus.volume.grid.size;
  int columns = 0;
  int hidden = 0;
  for (std::int64_t k = 0; k < size.z(); ++k)
    for (std::int64_t i = 0; i < size.x(); ++i) {
      bool wall = false;
      for (std::int64_t j = 0; j < size.y(); ++j) { // from anterior
        const auto label = labels[static_cast<std::size_t>(i + size.x() * (j + size.y() * k))];
        wall = wall || label == 3;
        if (label == 1) {
          ++columns;
          hidden += wall;
          break;
        }
      }
    }
  EXPECT_GT(columns, 500);
  EXPECT_EQ(hidden, columns);
}

TEST(PhantomFetus, SpeckleIsWeakerThanTissueSignal) {
  const Phantom& fetus = smallFetus();
  const auto& labels = fetus.labels.layers.front();
  const auto& voxels = getVoxels(fetus);
  double sum = 0.0;
  double squares = 0.0;
  double fluid = 0.0;
  for (std::size_t i = 0; i < voxels.size(); ++i)
    if (labels[i] == 1) {
      sum += voxels[i];
      squares += static_cast<double>(voxels[i]) * voxels[i];
    } else if (labels[i] == 0) {
      fluid += voxels[i];
    }
  const auto count = static_cast<double>(countVoxels(1));
  const double mean = sum / count;
  const double sigma = std::sqrt(squares / count - mean * mean);
  EXPECT_GT(mean, 5.0 * fluid / static_cast<double>(countVoxels(0)));
  EXPECT_GT(sigma, 0.1 * mean);
  EXPECT_LT(sigma, 0.6 * mean);
}

TEST(PhantomFetus, IsReproducibleWithAnyNumberOfThreads) {
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const Phantom again = makeFetusPhantom({64, 64, 64});
  EXPECT_EQ(getVoxels(again), getVoxels(smallFetus()));
  EXPECT_EQ(again.labels.layers, smallFetus().labels.layers);
}

TEST(PhantomFetus, RefusesSizesOutOfRange) {
  EXPECT_THROW(makeFetusPhantom({8, 64, 64}), Error);
}

} // namespace
} // namespace fenestra::core::PhantomFetusTests
