// A transparent focus as solid bodies, with gaps between segments that touch.

#include "Support.h"
#include "scene/DefaultTransfer.h"
#include "scene/SolidFocus.h"

#include <gtest/gtest.h>

namespace fenestra::core::testing::SolidFocusTests {
namespace {

/// A row of slabs of 2 mm voxels: two lungs, a vessel, a second layer with a bronchus in the first
/// lung, and an empty segment.
class SolidFocus : public ::testing::Test {
protected:
  SolidFocus() {
    LargeArray<std::uint8_t> labels;
    for (std::int64_t i = 0; i < grid.voxelCount(); ++i) {
      const std::int64_t x = i % 16;
      labels.push_back(static_cast<std::uint8_t>(x < 12 ? 1 + x / 4 : 0));
      labels.push_back(x == 1 ? 1 : 0);
    }
    segments = std::make_shared<SegmentsInput>(SegmentsInput{
        Segmentation("s", grid, 2, labels,
                     {{.id = "a", .name = "left", .labelValue = 1},
                      {.id = "b", .name = "right", .labelValue = 2},
                      {.id = "c", .name = "vessel", .labelValue = 3},
                      {.id = "d", .name = "empty", .labelValue = 4},
                      {.id = "e", .name = "bronchus", .labelValue = 1, .layer = 1}})});
    transfer->function.extinction =
        ScalarFunction({{-500.0, ScalarFunction::Value(0.0)}, {0.0, ScalarFunction::Value(1.0)}});
  }

  TransparentFocus find(const std::vector<std::string>& names) const {
    const auto hasVoxels = std::make_shared<std::vector<bool>>(findNonEmpty(segments));
    return findTransparentFocus(segments, hasVoxels, names, volume, transfer);
  }
  /// Voxels of each segment between gaps.
  std::vector<std::int64_t> countSeparated(const std::vector<std::string>& names) const {
    std::vector<std::int64_t> counts;
    const auto separated =
        separateSegments(segments, std::make_shared<TransparentFocus>(find(names)), volume);
    for (const SegmentStatistics& segment : separated->segmentation.statistics())
      counts.push_back(segment.voxels);
    return counts;
  }

  const Grid grid = makeCenteredGrid({16, 10, 10}, {2.0, 2.0, 2.0});
  const VolumeHandle volume =
      std::make_shared<VolumeInput>(VolumeInput{makeVolume<std::int16_t>(grid, [](const Vec3& p) {
        return p.x() < 4 ? -850 : p.x() < 8 ? -700 : p.x() < 10 ? 40 : -800;
      })});
  const std::shared_ptr<TransferChoice> transfer =
      std::make_shared<TransferChoice>(TransferChoice{makeRelativeTransfer(volume->volume), ""});
  Handle<SegmentsInput> segments;
};

TEST_F(SolidFocus, HasNoVisibleSegment) {
  EXPECT_EQ(find({"left", "empty", "right"}), (TransparentFocus{{0, -850.0}, {1, -700.0}}));
  EXPECT_EQ(find({"left", "vessel"}), TransparentFocus());
  EXPECT_EQ(find({"empty"}), TransparentFocus());
}

TEST_F(SolidFocus, SegmentsThatTouchAreSeparated) {
  EXPECT_EQ(countSeparated({"left", "right"}), (std::vector<std::int64_t>{200, 400, 400, 0, 100}))
      << "two voxels, 4 mm, of the first";
  EXPECT_EQ(countSeparated({"right", "bronchus"}), countSeparated({})) << "4 mm apart";
  EXPECT_EQ(countSeparated({"left", "bronchus"}), countSeparated({}))
      << "a lung would lose over half around a bronchus";
}

} // namespace
} // namespace fenestra::core::testing::SolidFocusTests
