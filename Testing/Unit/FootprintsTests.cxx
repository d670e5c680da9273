// Depth bounds of the cells of a depth buffer.

#include "ClippingTesting.h"
#include "base/Random.h"
#include "clip/focus/FocusDepth.h"
#include "clip/focus/Footprints.h"

#include <gtest/gtest.h>

namespace fenestra::core::FootprintsTests {
using namespace testing_clipping;

namespace {

/// Ball of isolated voxels: the content of one buffer cell does not predict that of the next.
Mask makeDust(const Grid& grid) {
  Mask mask = makeSphereMask(grid, 20.3);
  Random random(7, 0, 0);
  for (std::uint8_t& voxel : mask.voxels)
    if (toUniform(random.bits()) < 0.99)
      voxel = 0;
  return mask;
}

/// Expects that rays through cells hit the focus within the depth bounds of the cells.
void expectHitsInBounds(const FocusTracer& tracer, const DepthBuffer& buffer,
                        const CellRange& range, const std::vector<Interval>& bounds,
                        Random& random) {
  std::vector<Vec2> positions(5000);
  for (Vec2& position : positions)
    position = Vec2(uniform(random, -22, 22), uniform(random, -22, 22));
  const std::vector<double> depths = tracer.findDepths(positions);
  int hits = 0;
  for (std::size_t i = 0; i < positions.size(); ++i)
    if (depths[i] < infinity) {
      const DepthBuffer::Cell cell = buffer.cell(positions[i]);
      const Interval& bound = bounds[range.at(cell.column, cell.row)];
      ASSERT_LE(bound.begin, depths[i])
          << "at x = " << positions[i].x() << ", y = " << positions[i].y();
      ASSERT_GE(bound.end, depths[i])
          << "at x = " << positions[i].x() << ", y = " << positions[i].y();
      ++hits;
    }
  EXPECT_GT(hits, 200);
}

/// Pixels are wider or narrower than the focus cells.
TEST(Footprints, DepthBoundsContainTheFocusForAnyRequestedCells) {
  const Grid grid = makeCenteredGrid({60, 60, 60});
  const Mask focus = makeDust(grid);
  for (const int pixels : {8, 100}) {
    const Camera camera = makeAnteriorCamera(Projection::perspective, 200.0, 30.0, pixels, pixels);
    const FocusTracer tracer(camera, Domain(grid), focus);
    const DepthBuffer buffer = tracer.traceDepths().depth;
    const FocusCells& cells = tracer.cells();
    const CellRange range = findFocusRange(camera, buffer, cells);
    const auto computeBounds = [&](const std::vector<std::uint8_t>& isRequested) {
      return computeDepthBounds(camera, buffer, cells, range, isRequested);
    };
    const std::vector<Interval> all = computeBounds(std::vector<std::uint8_t>(range.size(), 1));
    Random random(8, 0, 0);
    expectHitsInBounds(tracer, buffer, range, all, random);
    for (const double probability : {0.001, 0.05, 0.6}) {
      std::vector<std::uint8_t> requested(range.size());
      for (std::uint8_t& flag : requested)
        flag = toUniform(random.bits()) < probability ? 1 : 0;
      const std::vector<Interval> bounds = computeBounds(requested);
      for (std::size_t i = 0; i < requested.size(); ++i) {
        const Interval expected = requested[i] != 0 ? all[i] : Interval{infinity, -infinity};
        ASSERT_EQ(bounds[i].begin, expected.begin) << pixels << " pixels, cell " << i;
        ASSERT_EQ(bounds[i].end, expected.end) << pixels << " pixels, cell " << i;
      }
    }
  }
}

} // namespace
} // namespace fenestra::core::FootprintsTests
