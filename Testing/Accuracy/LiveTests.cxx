#include "LiveMeasure.h"
#include "TemporaryFolder.h"

#include <gtest/gtest.h>

namespace fenestra::core::accuracy {
namespace {

/// A coarse knee, with voxels of 1.3 mm.
class LiveSurface : public ::testing::Test {
protected:
  TemporaryFolder m_folder;
  LiveSubject m_knee = LiveSubject(makeKnee(m_folder.path(), "120x138x48"));
};

/// The same surface as that of stills, but for the focus's triangles and the fill's coarser grid.
TEST_F(LiveSurface, EqualsThatOfStills) {
  for (const bool isPerspective : {false, true})
    for (const int number : {0, 2}) {
      const LiveDifference difference =
          m_knee.compare(m_knee.makeView(number, 4, 256, isPerspective));
      EXPECT_GT(difference.focus.count, 5000u);
      EXPECT_LT(difference.focus.mean, 1.2); // depths jump where parts hide others
      EXPECT_LT(difference.focus.p95, 0.5);
      EXPECT_LT(difference.context.mean, 1.2);
      EXPECT_LT(difference.context.p95, 3.0);
    }
}

/// Mean change of the context's depth per 0.1 degrees.
TEST_F(LiveSurface, MovesLittleWhileTheCameraTurns) {
  for (const int number : {0, 2})
    EXPECT_LT(m_knee.measureTurn(number), 0.4);
}

} // namespace
} // namespace fenestra::core::accuracy
