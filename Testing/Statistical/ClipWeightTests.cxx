// Clip weights and gradients of Fenestra and of the oracle at random points. Images average over
// them: they show small differences with many samples only.

#include "Matrix.h"
#include "Oracle/Clipping.h"
#include "Oracle/Medium.h"
#include "RunSettings.h"
#include "base/Random.h"

#include <gtest/gtest.h>

namespace fenestra::core::testing {
namespace {

struct Differences {
  int points = 0, weights = 0, gradients = 0;
};

Differences countDifferences(const Combination& c, int points) {
  const MatrixScene scene = makeMatrixScene(c);
  const TestScene& fenestra = scene.fenestra;
  const std::optional<Affine> crop =
      fenestra.crop ? std::optional(fenestra.crop->boxToWorld) : std::nullopt;
  const oracle::Medium medium(fenestra.volume, fenestra.transfer, crop);
  const oracle::View view(fenestra.pose);
  const oracle::Clipping clipping(scene.clip, view, medium);
  Random random(static_cast<std::uint64_t>(c.index));
  const Grid& grid = fenestra.volume.grid;
  Differences differences;
  for (int i = 0; i < points; ++i) {
    Vec3 index;
    for (int axis = 0; axis < 3; ++axis)
      index[axis] = static_cast<double>(grid.size[axis]) * random.uniform() - 0.5;
    const Vec3 world = grid.indexToWorld * index;
    if (!medium.contains(world))
      continue;
    ++differences.points;
    const double weight = clipWeight(fenestra.clip, world) - clipping.clipWeight(world);
    const Vec3 gradient = cutGradient(fenestra.clip, world) - clipping.cutGradient(world);
    differences.weights += std::abs(weight) > 1e-3 ? 1 : 0;
    differences.gradients += gradient.norm() > 1e-3 ? 1 : 0;
  }
  return differences;
}

/// The oracle finds the focus by steps along the ray. It may miss where the ray grazes the focus,
/// and differ by rounding at edges, where the weight jumps.
TEST(ClipWeights, EqualThoseOfTheOracle) {
  constexpr int points = 20'000;
  int combinations = 0;
  for (const Combination& c : makeCombinations(isLongRun() ? longCount : 60)) {
    if (c.clip == ClipFactor::none)
      continue;
    SCOPED_TRACE(describe(c));
    const Differences differences = countDifferences(c, points);
    EXPECT_GT(differences.points, points / 50);
    EXPECT_LE(differences.weights, points / 2000);
    EXPECT_LE(differences.gradients, points / 2000);
    ++combinations;
  }
  EXPECT_GT(combinations, 30);
}

} // namespace
} // namespace fenestra::core::testing
