// Reciprocity: light that travels along b and leaves a volume against a, all of it together, is as
// much as light that travels along a and leaves against b (Chandrasekhar, Radiative Transfer, 1960,
// ch. VII: the scattering function is symmetric), because extinction does not know directions and
// the phase function only the angle between them. Hybrid surfaces are excluded: as a share of what
// collides, what they scatter is their reflectance times the cosine toward the light but not that
// toward the viewer (design, section 1), so exchanging the two changes it.

#include "Clumps.h"

#include <array>

namespace fenestra::testing {
namespace {

enum class Cut { none, plane };

class Reciprocity : public ::testing::TestWithParam<std::tuple<double, Cut>> {};

/// Keeps two thirds of the volume; the camera means nothing to it in parallel projection.
Clip cutOf(Cut cut, const CameraPose& pose) {
  if (cut == Cut::none)
    return ClipNone{};
  return ClipPlane{Camera(pose, 1, 1), Vec3(0.1, -0.3, 0.2), Vec3(0.5, -1.0, 0.3).normalized()};
}

TEST_P(Reciprocity, ExchangesLightAndViewer) {
  const auto [g, cut] = GetParam();
  TestScene scene = clumps(Rgb(1.0, 0.5, 0.9), Rgb(0.7, 1.0, 0.2), g);
  scene.clip = cutOf(cut, scene.pose);
  std::uint64_t seed = 9000 + static_cast<std::uint64_t>(10.0 * (g + 1.0));
  const std::array<std::array<Vec3, 2>, 3> ways = {
      {{Vec3(0.2, 1.0, -0.3), Vec3(1.0, 0.1, 0.4)},     // aside
       {Vec3(-0.3, -0.5, 1.0), Vec3(0.5, 0.8, -1.0)},   // forward
       {Vec3(0.9, -0.4, -0.2), Vec3(0.6, -1.0, 0.1)}}}; // back
  for (const auto& [one, other] : ways) {
    const Vec3 a = one.normalized();
    const Vec3 b = other.normalized();
    SCOPED_TRACE(a.dot(b));
    const RgbEstimate there = scatteredOut(scene, b, a, budget(2500), seeded(seed));
    const RgbEstimate back = scatteredOut(scene, a, b, budget(2500), seeded(seed + 1));
    const Rgb error = (there + back).error;
    seed += 2;
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(there.mean[c], back.mean[c], 4.0 * error[c]);
      EXPECT_LT(error[c], 0.015 * there.mean[c]);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Volumes, Reciprocity,
                         ::testing::Combine(::testing::Values(0.6, -0.4),
                                            ::testing::Values(Cut::none, Cut::plane)));

} // namespace
} // namespace fenestra::testing
