// Reaches of the cells of a depth buffer.

#include "ClippingTesting.h"
#include "base/Random.h"
#include "clip/focus/FocusDepth.h"
#include "clip/focus/Footprints.h"

#include <gtest/gtest.h>

namespace fenestra::FootprintsTests {
using namespace testing_clipping;

namespace {

/// Ball of single voxels, so that what lies under one cell of the buffer tells nothing of the next.
Mask dust(const Grid& grid) {
  Mask mask = sphereMask(grid, 20.3);
  Random random(7, 0, 0);
  for (std::uint8_t& voxel : mask.voxels)
    if (uniformOf(random.bits()) < 0.99)
      voxel = 0;
  return mask;
}

/// Expects that rays through cells meet the focus within the cells' reaches.
void expectMeetings(const FocusTracer& tracer, const DepthBuffer& buffer, const CellRange& range,
                    const std::vector<Interval>& reaches, Random& random) {
  std::vector<Vec2> places(5000);
  for (Vec2& place : places)
    place = Vec2(uniform(random, -22, 22), uniform(random, -22, 22));
  const std::vector<double> depths = tracer.depthsAt(places);
  int met = 0;
  for (std::size_t i = 0; i < places.size(); ++i)
    if (depths[i] < infinity) {
      const DepthBuffer::Cell cell = buffer.cell(places[i]);
      const Interval& reach = reaches[range.at(cell.column, cell.row)];
      ASSERT_LE(reach.begin, depths[i]) << "at x = " << places[i].x() << ", y = " << places[i].y();
      ASSERT_GE(reach.end, depths[i]) << "at x = " << places[i].x() << ", y = " << places[i].y();
      ++met;
    }
  EXPECT_GT(met, 200);
}

/// Pixels both wider and narrower than the focus's cells.
TEST(Footprints, ReachesHoldTheFocusWhicheverCellsAreAskedFor) {
  const Grid grid = centredGrid({60, 60, 60});
  const Mask focus = dust(grid);
  for (const int pixels : {8, 100}) {
    const Camera camera = anteriorCamera(Projection::perspective, 200.0, 30.0, pixels, pixels);
    const FocusTracer tracer(camera, Domain(grid), focus);
    const DepthBuffer buffer = tracer.depths().depth;
    const FocusCells& cells = tracer.cells();
    const CellRange range = focusRange(camera, buffer, cells);
    const auto reachesOf = [&](const std::vector<std::uint8_t>& isAskedFor) {
      return focusReaches(camera, buffer, cells, range, isAskedFor);
    };
    const std::vector<Interval> all = reachesOf(std::vector<std::uint8_t>(range.size(), 1));
    Random random(8, 0, 0);
    expectMeetings(tracer, buffer, range, all, random);
    for (const double share : {0.001, 0.05, 0.6}) {
      std::vector<std::uint8_t> asked(range.size());
      for (std::uint8_t& each : asked)
        each = uniformOf(random.bits()) < share ? 1 : 0;
      const std::vector<Interval> reaches = reachesOf(asked);
      for (std::size_t i = 0; i < asked.size(); ++i) {
        const Interval expected = asked[i] != 0 ? all[i] : Interval{infinity, -infinity};
        ASSERT_EQ(reaches[i].begin, expected.begin) << pixels << " pixels, cell " << i;
        ASSERT_EQ(reaches[i].end, expected.end) << pixels << " pixels, cell " << i;
      }
    }
  }
}

} // namespace
} // namespace fenestra::FootprintsTests
