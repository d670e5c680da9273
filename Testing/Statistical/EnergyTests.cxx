// Energy balance of parallel light in a heterogeneous volume: scattered + absorbed = incident -
// transmitted.

#include "Clumps.h"
#include "LineIntegral.h"

namespace fenestra::core::testing::EnergyTests {
namespace {

/// Ray along `direction` from a square of half edge `half`, perpendicular to `direction`, 2 `half`
/// in front of the volume's center; `u` in [0, 1)^2 selects the point.
Ray makeParallelRay(const Grid& grid, const Vec3& direction, double half, const Vec2& u) {
  const Frame frame(direction);
  return {grid.worldCenter() - 2.0 * half * direction +
              half * ((2.0 * u.x() - 1.0) * frame.tangent + (2.0 * u.y() - 1.0) * frame.bitangent),
          direction};
}

/// Colliding light at irradiance 1, mm^2: 1 - exp(-optical depth), integrated over a plane that
/// faces the light, by the midpoint rule on `lines`^2 rays.
double computeCollidedLight(const TestScene& scene, const Vec3& light, int lines) {
  const LineIntegral integral(scene.volume, scene.transfer);
  const double half = scene.volume.grid.boundingRadius();
  double sum = 0.0;
  for (int row = 0; row < lines; ++row)
    for (int column = 0; column < lines; ++column)
      sum -= std::expm1(-integral.opticalDepth(
          makeParallelRay(scene.volume.grid, light, half, Vec2(column + 0.5, row + 0.5) / lines)));
  return sum * 4.0 * half * half / (lines * lines);
}

/// Light scattered into all directions, stratified: two random directions in each of many equal
/// parts of the sphere, whose difference estimates the variance within the part.
RgbEstimate estimateScatteredLight(TestScene& scene, const Vec3& light, std::uint64_t seed) {
  constexpr int rows = 20; // around the light's direction
  constexpr int columns = 12;
  const Frame frame(light);
  RgbEstimate sum;
  Rgb variance = Rgb::Zero();
  for (int part = 0; part < rows * columns; ++part) {
    Rgb pair[2];
    for (int i = 0; i < 2; ++i) {
      const std::uint64_t imageSeed = seed + static_cast<std::uint64_t>(2 * part + i);
      Random random(imageSeed, 0, 1);
      const Vec2 u = random.uniform2();
      const Vec3 direction = sampleUniformSphere(
          {(part / columns + u.x()) / rows, (part % columns + u.y()) / columns});
      pair[i] =
          estimateScattered(scene, light, -frame.toWorld(direction), scaleSamples(12UL), imageSeed)
              .mean;
    }
    sum.mean += 0.5 * (pair[0] + pair[1]);
    variance += 0.25 * (pair[0] - pair[1]).square();
  }
  sum.error = variance.sqrt();
  return sum * (4.0 * pi / (rows * columns));
}

// ---- absorbed light, by an independent forward random walk
// ---------------------------------------

Rgb interpolateAlbedo(const TransferFunction& transfer, double scalar) {
  const auto& knots = transfer.albedo.knots(); // two, at 0 and 1
  return knots[0].value + scalar * (knots[1].value - knots[0].value);
}

/// Samples Henyey and Greenstein's distribution by inversion.
Vec3 sampleDirection(const Vec3& direction, double g, const Vec2& u) {
  const double s = (1.0 - g * g) / (1.0 - g + 2.0 * g * u.x());
  const double cosine = g == 0.0 ? 2.0 * u.x() - 1.0 : (1.0 + g * g - s * s) / (2.0 * g);
  const double sine = std::sqrt(std::max(0.0, 1.0 - cosine * cosine));
  const double phi = 2.0 * pi * u.y();
  const Vec3 other = Frame(direction).tangent;
  return (cosine * direction +
          sine * (std::cos(phi) * other + std::sin(phi) * direction.cross(other)))
      .normalized();
}

/// Absorbed fraction of a walk's power: free paths with one majorant; a real collision absorbs 1 -
/// albedo.
Rgb traceAbsorbedPower(const TestScene& scene, const LineIntegral& medium, Ray ray,
                       Random& random) {
  double majorant = 0.0;
  for (const auto& knot : scene.transfer.extinction.knots())
    majorant = std::max(majorant, knot.value.value());
  Rgb absorbedPower = Rgb::Zero();
  Rgb power = Rgb::Ones();
  while (power.maxCoeff() > 1e-4) { // the remainder is negligible
    const Interval inside = medium.boxInterval(ray);
    const double distance = std::max(inside.begin, 0.0) - std::log1p(-random.uniform()) / majorant;
    if (!(distance < inside.end))
      break;
    ray.origin = ray.at(distance);
    const double scalar = medium.interpolate(ray.origin);
    if (random.uniform() * majorant >= medium.extinction(scalar))
      continue;
    const Rgb albedo = interpolateAlbedo(scene.transfer, scalar);
    absorbedPower += power * (1.0 - albedo);
    power *= albedo;
    ray.direction = sampleDirection(ray.direction, scene.transfer.g, random.uniform2());
  }
  return absorbedPower;
}

/// Absorbed light at irradiance 1, mm^2.
RgbEstimate estimateAbsorbedLight(const TestScene& scene, const Vec3& light, std::uint64_t seed) {
  const LineIntegral medium(scene.volume, scene.transfer);
  const double half = scene.volume.grid.boundingRadius();
  const std::uint64_t walks = scaleSamples(200000UL);
  Rgb sum = Rgb::Zero();
  Rgb squares = Rgb::Zero();
  for (std::uint64_t i = 0; i < walks; ++i) {
    Random random(seed, i, 2);
    const Ray ray = makeParallelRay(scene.volume.grid, light, half, random.uniform2());
    const Rgb absorbedPower = traceAbsorbedPower(scene, medium, ray, random);
    sum += absorbedPower;
    squares += absorbedPower.square();
  }
  const auto n = static_cast<double>(walks);
  const Rgb mean = sum / n;
  return RgbEstimate{mean, ((squares / n - mean.square()) / n).sqrt()} * (4.0 * half * half);
}

// ---- energy balance
// ---------------------------------------------------------------------------------

/// Relative error of computeCollidedLight() with this number of lines.
constexpr double quadratureError = 3e-4;
constexpr int lines = 120;

const Vec3 lightDirection = Vec3(0.4, -0.7, -0.5).normalized();

class Energy : public ::testing::TestWithParam<double> {};

TEST_P(Energy, WithoutAbsorptionOutgoingEqualsIncoming) {
  TestScene scene = makeClumps(Rgb::Ones(), Rgb::Ones(), GetParam());
  const double in = computeCollidedLight(scene, lightDirection, lines);
  EXPECT_NEAR(computeCollidedLight(scene, lightDirection, 2 * lines) / in, 1.0, quadratureError);
  const double silhouette = 4.0 * std::pow(scene.volume.grid.boundingRadius(), 2.0);
  EXPECT_GT(in, 0.1 * silhouette) << "the medium must have an effect";
  expectMean(estimateScatteredLight(scene, lightDirection, shiftSeed(7000)), Rgb::Constant(in),
             0.01, quadratureError);
}

TEST_P(Energy, OutgoingPlusAbsorbedEqualsIncoming) {
  TestScene scene = makeClumps(Rgb(0.95, 0.7, 0.9), Rgb(0.8, 0.95, 0.4), GetParam());
  const double in = computeCollidedLight(scene, lightDirection, lines);
  const RgbEstimate out = estimateScatteredLight(scene, lightDirection, shiftSeed(8000));
  const RgbEstimate absorbedLight = estimateAbsorbedLight(scene, lightDirection, shiftSeed(8500));
  EXPECT_GT((out.mean / absorbedLight.mean).minCoeff(), 0.2) << "both must have an effect";
  EXPECT_LT((out.mean / absorbedLight.mean).maxCoeff(), 5.0) << "both must have an effect";
  expectMean(out + absorbedLight, Rgb::Constant(in), 0.01, quadratureError);
}

INSTANTIATE_TEST_SUITE_P(Anisotropies, Energy, ::testing::Values(0.0, 0.5, -0.5));

} // namespace
} // namespace fenestra::core::testing::EnergyTests
