// Reciprocity: the light that enters a volume along b and leaves it along -a equals the light that
// enters along a and leaves along -b. Extinction does not depend on direction, and the phase
// function only on the angle between directions. Hybrid surfaces are excluded: their weight is
// reflectance times the cosine toward the light, without the cosine toward the viewer, so swapping
// light and viewer changes the result.

#include "Clumps.h"

#include <array>

namespace fenestra::core::testing::ReciprocityTests {
namespace {

enum class Cut { none, plane };

/// Plate that is clear at one end, dense and bright at the other: paths through its faces and ends
/// differ as much as possible, and so do the effects of errors.
Volume makePlate() {
  Random random(92, 0, 0);
  return makeVolume(makeCenteredGrid({9, 6, 3}, Vec3::Constant(0.6)),
                    [&](const Vec3& p) { return 0.7 - 0.08 * p.x() + 0.3 * random.uniform(); });
}

class Reciprocity : public ::testing::TestWithParam<std::tuple<double, Cut>> {};

/// Clip that leaves more than half of the volume; its camera is irrelevant in parallel projection.
Clip makeClip(Cut cut, const CameraPose& pose) {
  if (cut == Cut::none)
    return ClipNone{};
  return ClipPlane{Camera(pose, 1, 1), Vec3(0.1, -0.3, 0.2), Vec3(0.5, -1.0, 0.3).normalized()};
}

TEST_P(Reciprocity, SwappingLightAndViewerKeepsRadiance) {
  const auto [g, cut] = GetParam();
  TestScene scene = makeClumps(Rgb(0.9, 0.3, 0.6), Rgb(1.0, 0.9, 0.4), g);
  scene.volume = makePlate();
  scene.clip = makeClip(cut, scene.pose);
  std::uint64_t seed = 9000 + static_cast<std::uint64_t>(10.0 * (g + 1.0));
  const std::array<std::array<Vec3, 2>, 3> directions = {
      {{Vec3(0.1, 0.2, -1.0), Vec3(1.0, 0.2, 0.1)},     // face and one end
       {Vec3(0.2, -0.1, 1.0), Vec3(-1.0, 0.3, 0.4)},    // face and the other
       {Vec3(1.0, -0.2, -0.1), Vec3(-0.6, 0.3, 1.0)}}}; // end and end
  for (const auto& [one, other] : directions) {
    const Vec3 a = one.normalized();
    const Vec3 b = other.normalized();
    SCOPED_TRACE(a.dot(b));
    const RgbEstimate forward =
        estimateScattered(scene, b, a, scaleSamples(5000UL), shiftSeed(seed));
    const RgbEstimate reversed =
        estimateScattered(scene, a, b, scaleSamples(5000UL), shiftSeed(seed + 1));
    const Rgb error = (forward + reversed).error;
    seed += 2;
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(forward.mean[c], reversed.mean[c], 4.0 * error[c]);
      EXPECT_LT(error[c], relaxError(0.015 * forward.mean[c]));
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Volumes, Reciprocity,
                         ::testing::Combine(::testing::Values(0.6, -0.4),
                                            ::testing::Values(Cut::none, Cut::plane)));

} // namespace
} // namespace fenestra::core::testing::ReciprocityTests
