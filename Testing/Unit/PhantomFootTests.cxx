#include "base/Error.h"
#include "files/segments/SegmentationReader.h"
#include "phantoms/Foot.h"
#include "phantoms/PhantomWriter.h"
#include "phantoms/Phantoms.h"

#include "Approx.h"
#include "TemporaryFolder.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <map>
#include <queue>

namespace fenestra::core::PhantomFootTests {
namespace {

const Phantom& smallFoot() {
  static const Phantom foot = makeFootPhantom({140, 56, 70});
  return foot;
}

const LargeArray<std::int16_t>& getVoxels(const Phantom& phantom) {
  return std::get<LargeArray<std::int16_t>>(phantom.volume.voxels);
}

const PhantomSegment& findSegment(const Phantom& phantom, const std::string& id) {
  for (const PhantomSegment& segment : phantom.segments)
    if (segment.id == id)
      return segment;
  throw std::runtime_error("no segment " + id);
}

std::vector<std::size_t> findVoxels(const Phantom& phantom, const std::string& id) {
  const PhantomSegment& segment = findSegment(phantom, id);
  const auto& labels = phantom.labels.layers.at(segment.layer);
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < labels.size(); ++i)
    if (labels[i] == segment.label)
      found.push_back(i);
  return found;
}

Vec3 computeVoxelPosition(const Grid& grid, std::size_t voxel) {
  const auto at = static_cast<std::int64_t>(voxel);
  const Size3 index(at % grid.size.x(), at / grid.size.x() % grid.size.y(),
                    at / (grid.size.x() * grid.size.y()));
  return grid.indexToWorld * Vec3(index.cast<double>());
}

Vec3 computeCentroid(const Phantom& phantom, const std::string& id) {
  Vec3 sum = Vec3::Zero();
  const auto voxels = findVoxels(phantom, id);
  for (const std::size_t voxel : voxels)
    sum += computeVoxelPosition(phantom.volume.grid, voxel);
  return sum / static_cast<double>(voxels.size());
}

double computeMedian(const Phantom& phantom, const std::string& id) {
  std::vector<std::int16_t> values;
  for (const std::size_t voxel : findVoxels(phantom, id))
    values.push_back(getVoxels(phantom)[voxel]);
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

std::vector<std::string> listBoneIds() {
  std::vector<std::string> ids;
  const FootBones foot;
  for (const FootBone& bone : foot.bones())
    ids.push_back(bone.id);
  return ids;
}

} // namespace

TEST(PhantomFoot, HasTwentySixBonesAndTwoStumps) {
  const std::vector<std::string> ids = listBoneIds();
  ASSERT_EQ(ids.size(), 28u);
  const auto count = [&](const std::string& part) {
    return std::count_if(ids.begin(), ids.end(),
                         [&](const std::string& id) { return id.find(part) != std::string::npos; });
  };
  for (const char* tarsal : {"calcaneus", "talus", "navicular", "cuboid", "tibia", "fibula"})
    EXPECT_EQ(count(tarsal), 1) << tarsal;
  EXPECT_EQ(count("cuneiform"), 3);
  EXPECT_EQ(count("metatarsal_"), 5);
  EXPECT_EQ(count("_phalanx_"), 14);
  EXPECT_EQ(count("middle_phalanx_1"), 0);
  for (const std::string& id : ids)
    EXPECT_GT(findVoxels(smallFoot(), id).size(), 15u) << id;
}

TEST(PhantomFoot, BonesAreArrangedAsInRightFoot) {
  const Phantom& foot = smallFoot();
  const auto at = [&](const char* id) { return computeCentroid(foot, id); };
  for (int ray = 1; ray < 5; ++ray) {
    const std::string inner = std::to_string(ray), outer = std::to_string(ray + 1);
    EXPECT_LT(computeCentroid(foot, "metatarsal_" + inner).x() + 8.0,
              computeCentroid(foot, "metatarsal_" + outer).x())
        << "the great toe of a right foot is medial, at smaller x";
  }
  for (int ray = 1; ray <= 5; ++ray) {
    const std::string n = std::to_string(ray);
    EXPECT_LT(computeCentroid(foot, "metatarsal_" + n).y(),
              computeCentroid(foot, "proximal_phalanx_" + n).y());
    EXPECT_LT(computeCentroid(foot, "proximal_phalanx_" + n).y(),
              computeCentroid(foot, "distal_phalanx_" + n).y());
  }
  EXPECT_GT(at("talus").z(), at("calcaneus").z() + 15.0);
  EXPECT_GT(at("tibia").z(), at("talus").z() + 20.0);
  EXPECT_GT(at("fibula").x(), at("tibia").x() + 15.0);
  EXPECT_GT(at("navicular").y(), at("talus").y() + 20.0);
  EXPECT_LT(at("navicular").x(), at("cuboid").x());
  EXPECT_GT(at("navicular").z(), at("cuboid").z() + 8.0) << "the arch is higher medially";
  EXPECT_LT(at("achilles_tendon").y(), at("tibia").y() - 20.0);
}

/// The two bones of a joint are close but do not touch.
TEST(PhantomFoot, JointsAreNarrowGaps) {
  const FootBones bones;
  const auto index = [&](const std::string& id) {
    for (std::size_t i = 0; i < bones.bones().size(); ++i)
      if (bones.bones()[i].id == id)
        return i;
    throw std::runtime_error(id);
  };
  const std::pair<const char*, const char*> joints[] = {{"tibia", "talus"},
                                                        {"fibula", "talus"},
                                                        {"calcaneus", "talus"},
                                                        {"talus", "navicular"},
                                                        {"calcaneus", "cuboid"},
                                                        {"navicular", "medial_cuneiform"},
                                                        {"navicular", "lateral_cuneiform"},
                                                        {"medial_cuneiform", "metatarsal_1"},
                                                        {"intermediate_cuneiform", "metatarsal_2"},
                                                        {"lateral_cuneiform", "metatarsal_3"},
                                                        {"cuboid", "metatarsal_4"},
                                                        {"cuboid", "metatarsal_5"},
                                                        {"metatarsal_1", "proximal_phalanx_1"},
                                                        {"metatarsal_5", "proximal_phalanx_5"},
                                                        {"proximal_phalanx_1", "distal_phalanx_1"},
                                                        {"middle_phalanx_3", "distal_phalanx_3"}};
  std::map<std::pair<std::size_t, std::size_t>, double> width;
  double overlap = infinity;
  for (double x = -50; x <= 50; x += 1.5)
    for (double y = 10; y <= 260; y += 1.5)
      for (double z = 4; z <= 100; z += 1.5) {
        const auto distances = bones.distances({x, y, z});
        for (const auto& [a, b] : joints) {
          const std::size_t i = index(a), j = index(b);
          if (distances[i] == FootBones::maxDistance || distances[j] == FootBones::maxDistance)
            continue;
          auto& least = width.try_emplace({i, j}, infinity).first->second;
          least = std::min(least, distances[i] + distances[j]);
        }
        std::array<double, FootBones::count> sorted = distances;
        std::nth_element(sorted.begin(), sorted.begin() + 1, sorted.end());
        overlap = std::min(overlap, sorted[1]);
      }
  for (const auto& [a, b] : joints) {
    EXPECT_GT((width[{index(a), index(b)}]), 0.5) << a << ' ' << b;
    EXPECT_LT((width[{index(a), index(b)}]), 4.5) << a << ' ' << b;
  }
  EXPECT_GT(overlap, 0.0) << "bones must not overlap";
}

TEST(PhantomFoot, BonesSegmentContainsVoxelsFrom200Hounsfield) {
  const Phantom& foot = smallFoot();
  const PhantomSegment& bones = findSegment(foot, "bones");
  EXPECT_EQ(bones.layer, 1u);
  const FootBones skeleton;
  for (std::size_t i = 0; i < getVoxels(foot).size(); ++i) {
    const bool found = foot.labels.layers[1][i] == bones.label;
    ASSERT_EQ(found, getVoxels(foot)[i] >= 200) << i;
    if (!found || foot.labels.layers[0][i] <= FootBones::count)
      continue;
    const auto distances = skeleton.distances(computeVoxelPosition(foot.volume.grid, i));
    EXPECT_LT(*std::min_element(distances.begin(), distances.end()), 1.6)
        << "a soft-tissue voxel without adjacent bone";
  }
  const auto total = static_cast<double>(findVoxels(foot, "bones").size());
  double anatomical = 0.0;
  for (const std::string& id : listBoneIds())
    anatomical += static_cast<double>(findVoxels(foot, id).size());
  EXPECT_GT(total / anatomical, 0.6);
  EXPECT_LT(total / anatomical, 1.1);
}

TEST(PhantomFoot, TissuesHaveTypicalHounsfieldUnits) {
  const Phantom& foot = smallFoot();
  EXPECT_NEAR(computeMedian(foot, "fat"), -105.0, 15.0);
  EXPECT_NEAR(computeMedian(foot, "muscles"), 52.0, 15.0);
  EXPECT_NEAR(computeMedian(foot, "achilles_tendon"), 100.0, 20.0);
  EXPECT_GT(computeMedian(foot, "talus"), 300.0);
  const FootSubject layers;
  const FootSite shaft = layers.makeSite({-14.0, 168.0, 39.0}, infinity);
  EXPECT_LT(footMarrowHu(shaft), 0.0) << "the canal of a metatarsal contains fat";
  EXPECT_GT(footCortexHu(shaft), 1200.0);
  EXPECT_NEAR(getVoxels(foot).front(), -1000.0, 60.0) << "air";
}

TEST(PhantomFoot, SkinCoversEveryBone) {
  const FootSubject layers;
  double thinnest = infinity;
  for (double x = -54; x <= 52; x += 2.0)
    for (double y = 0; y <= 268; y += 2.0)
      for (double z = 2; z <= 130; z += 2.0) {
        const FootSite s = layers.makeSite({x, y, z}, infinity);
        if (s.bones[s.nearest] < 0.0)
          thinnest = std::min(thinnest, -s.surface);
      }
  EXPECT_GT(thinnest, 2.0);
}

TEST(PhantomFoot, PositionIsIndependentOfSizeAndVoxelsOfThreads) {
  const Size3 size(48, 24, 28);
  const Phantom many = makeFootPhantom(size);
  const Grid& grid = many.volume.grid;
  EXPECT_TRUE(isApprox(grid.spacing().cwiseProduct(grid.size.cast<double>()), Vec3(280, 112, 140)));
  EXPECT_TRUE(isApprox(grid.worldCenter(), smallFoot().volume.grid.worldCenter()));
  EXPECT_GT(grid.indexToWorld.linear().determinant(), 0.0) << "right-handed";
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const Phantom single = makeFootPhantom(size);
  EXPECT_EQ(getVoxels(many), getVoxels(single));
  EXPECT_EQ(many.labels.layers, single.labels.layers);
  EXPECT_THROW(makeFootPhantom({48, 15, 28}), Error);
}

TEST(PhantomFoot, BothLayersRoundTripThroughFile) {
  const TemporaryFolder folder;
  const Phantom foot = makeFootPhantom({48, 24, 28});
  writePhantom(foot, folder.path(), "foot");
  const Segmentation segmentation = readSegmentation(folder / "foot.seg.nrrd");
  ASSERT_EQ(segmentation.segments().size(), foot.segments.size());
  for (const char* id : {"calcaneus", "skin", "bones"})
    EXPECT_EQ(segmentation.makeFocusMask({id}, foot.volume.grid).count,
              static_cast<std::int64_t>(findVoxels(foot, id).size()))
        << id;
}

} // namespace fenestra::core::PhantomFootTests
