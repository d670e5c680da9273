// Media of several components, against one component, closed forms, a furnace, and their majorants.

#include "Slab.h"

#include "clip/surface/ClippingSurface.h"

#include <algorithm>
#include <iostream>

namespace fenestra::core::testing::ComponentsTests {
namespace {

constexpr Integrator integrators[] = {Integrator::simd, Integrator::scalar};

/// Ball in a rotated label map of 1 mm voxels, with a sharp edge or one that is soft over 2 mm.
Mask makeBallMask(const Vec3& center, double radius, bool isSoft) {
  const Grid flat = makeCenteredGrid(Size3::Constant(23), Vec3::Constant(1.0));
  const Grid grid(flat.size,
                  makeRotation(0.4, Vec3(1.0, 2.0, -0.5).normalized()) * flat.indexToWorld);
  Mask mask;
  mask.grid = grid;
  mask.maxValue = isSoft ? 255 : 1;
  for (std::int64_t z = 0; z < grid.size.z(); ++z)
    for (std::int64_t y = 0; y < grid.size.y(); ++y)
      for (std::int64_t x = 0; x < grid.size.x(); ++x) {
        const Vec3 p = grid.indexToWorld * Size3(x, y, z).cast<double>();
        const double inside = radius - (p - center).norm();
        const double fraction = isSoft ? std::clamp(0.5 + inside / 2.0, 0.0, 1.0) : inside > 0.0;
        mask.voxels.push_back(static_cast<std::uint8_t>(fraction * mask.maxValue));
      }
  return mask;
}

/// Parts 1 to `count`: balls of three priorities, some of which overlap.
std::vector<LabelWeights::Part> makeBalls(int count, bool isSoft) {
  std::vector<LabelWeights::Part> parts;
  for (int i = 0; i < count; ++i) {
    const double angle = 2.4 * i, height = -6.0 + 12.0 * (i + 0.5) / count;
    const Vec3 center(5.0 * std::cos(angle), 5.0 * std::sin(angle), height);
    parts.push_back({makeBallMask(center, 3.0 + 0.2 * (i % 5), isSoft), i % 3,
                     static_cast<std::uint8_t>(i + 1)});
  }
  return parts;
}

Mixture makeMixture(const std::vector<LabelWeights::Part>& parts,
                    std::vector<Component> components) {
  return {std::make_shared<const LabelWeights>(makeLabelWeights(parts)), std::move(components)};
}

/// Hills of scalars 0 to 1, seen from the front.
TestScene makeHillScene(const TransferFunction& transfer) {
  TestScene scene{makeVolume(makeCenteredGrid({20, 24, 18}, {1.0, 0.8, 1.3}),
                             [](const Vec3& p) {
                               return 0.5 + 0.5 * std::sin(0.9 * p.x()) *
                                                std::cos(0.7 * p.y() + 0.3 * p.z());
                             }),
                  transfer,
                  {EnvironmentLight{}},
                  {},
                  12,
                  12};
  scene.pose.position = {5.0, 40.0, 12.0};
  scene.pose.target = Vec3::Zero();
  scene.pose.scale = 10.0;
  return scene;
}

TransferFunction makeCoatedTransfer() {
  TransferFunction transfer = makeLinearTransfer(0.6, Rgb(0.9, 0.6, 0.3), 0.4);
  transfer.shading = SurfaceShading::makeCoated(0.5, 0.3, transfer.g);
  return transfer;
}

RenderSettings makeSettings(Integrator integrator, std::uint64_t samples, std::uint64_t seed) {
  RenderSettings settings;
  settings.integrator = integrator;
  settings.samples = scaleSamples(samples);
  settings.seed = shiftSeed(seed);
  settings.path.background.kind = Background::Kind::environment;
  return settings;
}

// ---- identical components
// ----------------------------------------------------------------------------------

/// Expects two images of one scene, by the sum of squared z over pixels and channels, and the mean
/// z.
void expectSame(const Film& a, const Film& b) {
  double n = 0.0, squares = 0.0, sum = 0.0;
  for (std::size_t i = 0; i < a.pixelCount(); ++i) {
    const PixelSums &p = a.pixels()[i], &q = b.pixels()[i];
    const Rgb variance = p.standardError().square() + q.standardError().square();
    const Rgb difference = p.mean - q.mean;
    for (int c = 0; c < 3; ++c)
      if (variance[c] > 0.0) {
        const double z = difference[c] / std::sqrt(variance[c]);
        n += 1.0 / 3.0; // channels of a path are correlated
        squares += z * z / 3.0;
        sum += z / 3.0;
      }
  }
  ASSERT_GT(n, 50.0);
  std::cout << "z " << sum / std::sqrt(n) << ", chi2 / n " << squares / n << ", n " << n << '\n';
  EXPECT_LT(std::abs(sum / std::sqrt(n)), 4.0);
  EXPECT_LT(std::abs(squares - n) / std::sqrt(2.0 * n), 4.0);
}

/// Segments of the volume's own medium change random numbers only.
TEST(IdenticalComponents, RenderLikeOneMedium) {
  TransferFunction steep = makeCoatedTransfer();
  steep.gradientOpacity = ScalarFunction({makeKnot(0.0, 0.1), makeKnot(0.3, 1.0)});
  for (const TransferFunction& transfer : {makeCoatedTransfer(), steep})
    for (const Integrator integrator : integrators) {
      const TestScene alone = makeHillScene(transfer);
      TestScene mixed = makeHillScene(transfer);
      mixed.mixture = makeMixture(makeBalls(4, true), std::vector<Component>(5, {transfer}));
      expectSame(alone.render(makeSettings(integrator, 400, 61)).film,
                 mixed.render(makeSettings(integrator, 400, 62)).film);
    }
}

// ---- slabs
// ---------------------------------------------------------------------------------------

/// Mask values of a segment, 0 to 255, along a column of 1 mm voxels in z.
using Column = std::vector<std::uint8_t>;

Mask makeLayerMask(const Column& column) {
  const auto n = static_cast<std::int64_t>(column.size());
  Mask mask;
  mask.grid = makeCenteredGrid({2, 2, n}, {10000.0, 10000.0, 1.0});
  mask.maxValue = 255;
  for (const std::uint8_t voxel : column)
    mask.voxels.insert(mask.voxels.end(), 4, voxel);
  return mask;
}

/// Integral over z of a function that is linear between the voxels of a column, and constant in the
/// outer half voxels.
double integrate(const std::vector<double>& values) {
  double sum = 0.5 * (values.front() + values.back());
  for (std::size_t i = 0; i + 1 < values.size(); ++i)
    sum += 0.5 * (values[i] + values[i + 1]);
  return sum;
}

const Column lower = {255, 255, 250, 180, 77, 13, 0, 0};
const Column upper = {0, 40, 120, 200, 255, 255, 90, 20};

/// Slab of 8 mm and 0.25 per mm, with two overlapping segments of 0.6 and 0.1 per mm.
TestScene makeTwoSegmentSlab(int lowerPriority, int upperPriority) {
  TestScene scene = makeSlab(20000.0, 8.0, Rgb::Zero(), 0.25);
  scene.pose.scale = 1.0;
  const auto dense = [&](double sigma_t) {
    TransferFunction transfer = scene.transfer;
    transfer.extinction = ScalarFunction({makeKnot(0.0, sigma_t)});
    return transfer;
  };
  scene.mixture = makeMixture(
      {{makeLayerMask(lower), lowerPriority, 1}, {makeLayerMask(upper), upperPriority, 2}},
      {{scene.transfer}, {dense(0.6)}, {dense(0.1)}});
  return scene;
}

/// Optical depth along z, with label weights in 255ths, as they are stored.
double computeOpticalDepth(int lowerPriority, int upperPriority) {
  std::vector<double> extinctions;
  for (std::size_t i = 0; i < lower.size(); ++i) {
    double a = lower[i], b = upper[i];
    if (lowerPriority > upperPriority)
      b = std::min(b, 255.0 - a);
    else if (lowerPriority < upperPriority)
      a = std::min(a, 255.0 - b);
    else if (a + b > 255.0) {
      const double factor = 255.0 / (a + b);
      a = std::round(factor * a);
      b = 255.0 - a;
    }
    extinctions.push_back((0.6 * a + 0.1 * b + 0.25 * (255.0 - a - b)) / 255.0);
  }
  return integrate(extinctions);
}

/// Expects exp(-depth / mu) behind the slab, at five angles.
void expectTransmittance(TestScene scene, double depth, std::uint64_t seed) {
  for (const Integrator integrator : integrators)
    for (const double mu : {1.0, 0.9, 0.7, 0.5, 0.35}) {
      SCOPED_TRACE(mu);
      aimCamera(scene, downwardDirection(mu, 0.3));
      const RenderSettings settings = makeSettings(integrator, 500, seed++);
      const Estimate estimate = estimateMean(scene.render(settings).film);
      const double expected = std::exp(-depth / mu);
      // Every sample is 0 or 1.
      const double error =
          std::sqrt(expected * (1.0 - expected) / (64.0 * static_cast<double>(settings.samples)));
      EXPECT_NEAR(estimate.mean, expected, 4.0 * error);
    }
}

TEST(SlabOfComponents, TransmitsExpOfIntegral) {
  expectTransmittance(makeTwoSegmentSlab(20, 10), computeOpticalDepth(20, 10), 1000);
  expectTransmittance(makeTwoSegmentSlab(10, 20), computeOpticalDepth(10, 20), 1100);
  expectTransmittance(makeTwoSegmentSlab(10, 10), computeOpticalDepth(10, 10), 1200);
}

/// The removed half contains only the upper, unclipped segment.
TEST(SlabOfComponents, ClipRemovesOnlyClippedComponents) {
  TestScene scene = makeTwoSegmentSlab(20, 10);
  scene.mixture->components[2].isClipped = false;
  scene.clip =
      ClipPlane{Camera(scene.pose, scene.width, scene.height), Vec3::Zero(), Vec3::UnitZ()};
  const auto sum = [](std::size_t first, std::size_t end, auto&& extinction) {
    double all = 0.0; // from the middle of the slab, between two voxels, to a face
    for (std::size_t i = first; i < end; ++i)
      all += extinction(i);
    return all;
  };
  const auto upperWeight = [](std::size_t i) {
    return std::min<double>(upper[i], 255.0 - lower[i]) / 255.0;
  };
  const auto all = [&](std::size_t i) {
    const double a = lower[i] / 255.0, b = upperWeight(i);
    return 0.6 * a + 0.1 * b + 0.25 * (1.0 - a - b);
  };
  const auto left = [&](std::size_t i) { return 0.1 * upperWeight(i); };
  // Trapezoidal rule: the plane halves the interval between voxels 3 and 4.
  const double remaining = sum(0, 4, all) + (all(4) - all(3)) / 8.0;
  const double removed = sum(4, 8, left) - (left(4) - left(3)) / 8.0;
  expectTransmittance(scene, remaining + removed, 1300);
}

// ---- furnace
// -------------------------------------------------------------------------------------

/// Materials of albedo 1 with different phase functions, densities and roughnesses; every fourth is
/// unclipped.
std::vector<Component> makeWhiteComponents(bool isHybrid) {
  std::vector<Component> all;
  for (int i = 0; i < 15; ++i) {
    TransferFunction transfer =
        makeLinearTransfer(1.7 - 0.1 * i, Rgb::Ones(), 0.12 * (i % 8) - 0.2);
    if (i % 3 == 2)
      transfer.extinction = ScalarFunction({makeKnot(0.0, 0.8 - 0.05 * i)});
    if (isHybrid) {
      transfer.shading = SurfaceShading::makeCoated(0.0, 0.1 + 0.05 * i, transfer.g);
      transfer.shading->diffuse = 1.0;
    }
    all.push_back({transfer, i % 4 != 3});
  }
  return all;
}

TEST(FurnaceOfComponents, HasRadianceOne) {
  for (const bool isHybrid : {false, true})
    for (const bool isCutaway : {false, true})
      for (const Integrator integrator : integrators) {
        const std::vector<Component> components = makeWhiteComponents(isHybrid);
        TestScene scene = makeHillScene(components.front().transfer);
        scene.mixture = makeMixture(makeBalls(14, true), components);
        const Camera camera(scene.pose, scene.width, scene.height);
        scene.clip = ClipPlane{camera, Vec3(0.0, 2.0, 0.0), Vec3(0.2, 1.0, 0.1).normalized()};
        // Sampling a map adds noise; a constant environment is not sampled.
        scene.lights = {EnvironmentLight{Rgb::Ones(), {8, 4, std::vector<float>(96, 1.0F)}}};
        if (isCutaway) {
          scene.lights = {EnvironmentLight{}};
          scene.clip = buildClippingSurface(camera, Domain(scene.volume.grid, {}),
                                            makeBallMask(Vec3::Zero(), 4.0, false),
                                            {SurfaceMode::cutaway, 50, 0.5})
                           .clip;
        }
        const RenderResult result = scene.render(makeSettings(integrator, 128, 71));
        EXPECT_GT(result.counters.collisions, 10000U) << "the medium must have an effect";
        const Estimate estimate = estimateMean(result.film);
        EXPECT_NEAR(estimate.mean, 1.0, 4.0 * estimate.error + 1e-5); // SIMD code uses float
        EXPECT_LT(estimate.error, relaxError(0.01));
        if (isCutaway) {
          for (const PixelSums& pixel : result.film.pixels())
            EXPECT_NEAR(pixel.mean[0], 1.0, 4.0 * pixel.standardError()[0] + 1e-5);
        }
      }
}

// ---- order, bound
// --------------------------------------------------------------------------------

/// The order of segments has no effect, neither within one priority nor across priorities.
TEST(SegmentOrder, DoesNotChangeImage) {
  for (const bool isSoft : {false, true})
    for (const Integrator integrator : integrators) {
      std::vector<LabelWeights::Part> parts = makeBalls(7, isSoft);
      TestScene scene = makeHillScene(makeCoatedTransfer());
      scene.mixture = makeMixture(parts, makeWhiteComponents(true));
      const RenderSettings settings = makeSettings(integrator, 8, 81);
      const Film first = scene.render(settings).film;
      std::ranges::reverse(parts);
      std::rotate(parts.begin(), parts.begin() + 2, parts.end());
      // A label map starts where its first part starts: all of these start at one position.
      scene.mixture = makeMixture(parts, makeWhiteComponents(true));
      const Film other = scene.render(settings).film;
      for (std::size_t i = 0; i < first.pixelCount(); ++i)
        EXPECT_EQ(first.pixels()[i].mean, other.pixels()[i].mean);
    }
}

/// Expects no extinction above its cell's majorant, at points of the cell and of the padding in
/// which the majorant holds; returns the maximum ratio of an extinction to its majorant.
double expectBound(const TestScene& scene) {
  double maximum = 0.0;
  scene.visitView([&](const SceneView& parts) {
    const MajorantGrid& majorants = parts.majorants;
    const auto& voxels = std::get<LargeArray<float>>(scene.volume.voxels);
    const Medium<float> medium(scene.volume.grid, voxels, scene.transfer, parts.style, nullptr,
                               parts.mixture);
    const Affine toWorld = majorants.worldToCell().inverse();
    const Vec3 padding = MajorantGrid::margin * majorants.edge().cast<double>().cwiseInverse();
    Random random(shiftSeed(91), 0, 0);
    const Size3& count = majorants.cellCount();
    std::int64_t cell = 0;
    for (std::int64_t z = 0; z < count.z(); ++z)
      for (std::int64_t y = 0; y < count.y(); ++y)
        for (std::int64_t x = 0; x < count.x(); ++x, ++cell)
          for (int i = 0; i < scaleSamples(4); ++i) {
            const Vec3 u(random.uniform(), random.uniform(), random.uniform());
            const Vec3 inCell = (1.0 + 2.0 * padding.array()) * u.array() - padding.array();
            const Vec3 world = toWorld * (Size3(x, y, z).cast<double>() + inCell);
            const MajorantGrid::Cell& bound = majorants.cell(cell);
            const double weight = bound.isCut ? clipWeight(scene.clip, world) : 1.0;
            const double extinction =
                bound.majorant > 0.0F
                    ? medium.extinction(scene.volume.grid.worldToIndex * world, weight)
                    : medium.extinction(scene.volume.grid.worldToIndex * world,
                                        clipWeight(scene.clip, world));
            EXPECT_LE(extinction, static_cast<double>(bound.majorant));
            if (bound.majorant > 0.0F)
              maximum = std::max(maximum, extinction / static_cast<double>(bound.majorant));
          }
    return 0;
  });
  return maximum;
}

TEST(MajorantOfComponents, IsNeverExceeded) {
  for (const bool isSoft : {false, true})
    for (const bool isSteep : {false, true})
      for (const bool isThin : {false, true}) {
        TransferFunction own = makeCoatedTransfer();
        if (isSteep)
          own.gradientOpacity =
              ScalarFunction({makeKnot(0.0, 0.1), makeKnot(0.3, 1.0), makeKnot(0.6, 0.2)});
        TestScene scene = makeHillScene(own);
        std::vector<Component> components = makeWhiteComponents(true);
        components[0].transfer = components[3].transfer = own;
        scene.mixture = makeMixture(makeBalls(14, isSoft), components);
        scene.clip = ClipPlane{Camera(scene.pose, scene.width, scene.height),
                               Vec3::Zero(),
                               Vec3(0.2, 1.0, 0.1).normalized(),
                               {0.2, isSoft ? 2.0 : 0.0}};
        if (isThin)
          scene.style.emplace(ContextStyle{
              std::make_shared<const Mask>(makeBallMask(Vec3::Zero(), 4.0, false)), 0.3, 1.0});
        EXPECT_GT(expectBound(scene), 0.95) << "majorants are too loose";
      }
}

} // namespace
} // namespace fenestra::core::testing::ComponentsTests
