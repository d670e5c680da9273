// Extreme transfer functions and constant volumes, against analytic integrals of the functions.

#include "StressSupport.h"

#include "Curves.h"

namespace fenestra::core::testing::TransferStressTests {
namespace {

using Knots = std::vector<ScalarFunction::Knot>;

constexpr double lowest = -200.0; // scalars of the volume
constexpr double highest = 300.0;

/// Volume of 11 layers of 1 mm along z.
Volume makeScalarRamp() {
  return makeVolume<std::int16_t>(makeCenteredGrid({2, 2, 11}, Vec3::Ones()), [](const Vec3& p) {
    return lowest + (highest - lowest) * p.z() / 10.0;
  });
}

/// Right-hand limit at s (a step has the value of its right side), from sorted knots.
double evaluate(const Knots& knots, double s) {
  double value = knots.front().value[0];
  for (std::size_t i = 0; i < knots.size(); ++i) {
    if (knots[i].position > s)
      break;
    value = knots[i].value[0];
    if (i + 1 < knots.size() && knots[i + 1].position > s) {
      const double t = (s - knots[i].position) / (knots[i + 1].position - knots[i].position);
      value += t * (knots[i + 1].value[0] - value);
    }
  }
  return value;
}

/// Integral of the function over the volume's scalars, by trapezoids between knots.
double integrate(const Knots& knots) {
  std::vector<double> ends = {lowest, highest};
  for (const auto& k : knots)
    if (k.position > lowest && k.position < highest)
      ends.push_back(k.position);
  std::sort(ends.begin(), ends.end());
  double sum = 0.0;
  for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
    const double width = ends[i + 1] - ends[i];
    if (width > 1e-6) // linear inside, so two interior points determine the line
      sum += 0.5 * width *
             (evaluate(knots, ends[i] + 0.25 * width) + evaluate(knots, ends[i] + 0.75 * width));
  }
  return sum;
}

/// Optical depth of a ray along the ramp: 10 mm, plus half a voxel at each end.
double computeOpticalDepth(const Knots& knots) {
  return 0.5 * evaluate(knots, lowest) + integrate(knots) / (highest - lowest) * 10.0 +
         0.5 * evaluate(knots, highest);
}

struct TransferCase {
  const char* name;
  Knots knots; ///< sorted by position
};

const double justAbove50 = std::nextafter(50.0, 51.0);

std::vector<TransferCase> makeTransferCases() {
  return {
      {"oneKnot", {makeKnot(50, 0.1)}},
      {"oneKnotFarOutside", {makeKnot(1e30, 0.1)}},
      {"allZero", {makeKnot(-100, 0), makeKnot(0, 0), makeKnot(100, 0)}},
      {"step", {makeKnot(50, 0.05), makeKnot(50, 0.3)}},
      {"stepWithThreeKnots", {makeKnot(50, 0.05), makeKnot(50, 0.9), makeKnot(50, 0.3)}},
      {"stepDown", {makeKnot(-100, 0.4), makeKnot(50, 0.4), makeKnot(50, 0), makeKnot(100, 0)}},
      {"stepsInOneVoxel",
       {makeKnot(20, 0), makeKnot(20, 1), makeKnot(25, 1), makeKnot(25, 0), makeKnot(30, 0),
        makeKnot(30, 2), makeKnot(32, 2), makeKnot(32, 0)}},
      {"stepAtMinimum", {makeKnot(lowest, 0.8), makeKnot(lowest, 0.1)}},
      {"stepAtMaximum", {makeKnot(highest, 0.1), makeKnot(highest, 0.4)}},
      {"stepAtVoxel", {makeKnot(100, 0.0), makeKnot(100, 0.2)}},
      {"oneUlpWide", {makeKnot(50, 0.05), makeKnot(justAbove50, 0.3)}},
      {"minimumSpan", {makeKnot(0, 0.05), makeKnot(5e-324, 0.3)}},
      {"subnormalSpan", {makeKnot(0, 0.05), makeKnot(1e-310, 0.2), makeKnot(2e-310, 0.3)}},
      {"below", {makeKnot(-5000, 0), makeKnot(-4000, 0.2)}},
      {"above", {makeKnot(4000, 0.1), makeKnot(5000, 0.9)}},
      {"around", {makeKnot(-1e30, 0.2), makeKnot(1e30, 0.0)}},
      {"aroundWithSpike",
       {makeKnot(-1e30, 0), makeKnot(40, 0), makeKnot(50, 1), makeKnot(60, 0), makeKnot(1e30, 0)}},
      {"descending", {makeKnot(-200, 0.4), makeKnot(0, 0.1), makeKnot(300, 0)}},
      {"negativeScalars", {makeKnot(-150, 0), makeKnot(-120, 0.6), makeKnot(-50, 0)}},
      {"narrowSpikes",
       {makeKnot(-37.51, 0), makeKnot(-37.5, 100), makeKnot(-37.49, 0), makeKnot(212.4, 0),
        makeKnot(212.5, 40), makeKnot(212.6, 0)}},
      {"tiny", {makeKnot(0, 1e-300), makeKnot(100, 1e-310)}}};
}

class TransferExtremes : public ::testing::TestWithParam<TransferCase> {};

TEST_P(TransferExtremes, TransmittanceEqualsExpOfIntegral) {
  const Volume volume = makeScalarRamp();
  const double expected = std::exp(-computeOpticalDepth(GetParam().knots));
  Knots unsorted = GetParam().knots; // positions in any order; coincident knots keep their order
  std::stable_sort(unsorted.begin(), unsorted.end(),
                   [](const auto& a, const auto& b) { return a.position > b.position; });
  for (const Knots& knots : {GetParam().knots, unsorted}) {
    const RayProbe<std::int16_t> probe(
        volume, {ScalarFunction(knots), ColorFunction({{0.0, Rgb::Zero()}})});
    for (const double sign : {1.0, -1.0})
      probe.expectTransmittance({{0.2, -0.3, -20.0 * sign}, sign * Vec3::UnitZ()}, {}, expected,
                                scaleSamples(6000));
  }
}

TEST_P(TransferExtremes, FurnaceIsOne) {
  TestScene scene{makeScalarRamp(),
                  {ScalarFunction(GetParam().knots), ColorFunction({{0.0, Rgb::Ones()}})},
                  {EnvironmentLight{}},
                  {},
                  8,
                  8};
  scene.pose.position = {10.0, -10.0, 8.0};
  scene.pose.target = Vec3::Zero();
  scene.pose.scale = 5.0;
  const RenderResult result = renderScene(scene, scaleSamples(60));
  expectRadianceOne(result);
  if (std::string(GetParam().name) == "allZero") {
    EXPECT_EQ(result.counters.lookups, 0U);
    EXPECT_EQ(result.counters.skippedCells, result.counters.cells);
  }
}

INSTANTIATE_TEST_SUITE_P(Functions, TransferExtremes, ::testing::ValuesIn(makeTransferCases()),
                         [](const auto& info) { return std::string(info.param.name); });

// ---- Slicer's volume property

struct PropertyCase {
  const char* name;
  std::vector<OpacityNode> opacity;
  double unitDistance;
};

class PropertyExtremes : public ::testing::TestWithParam<PropertyCase> {};

TEST_P(PropertyExtremes, TransmittanceEqualsFormula) {
  VolumeProperty property;
  property.scalarOpacity = GetParam().opacity;
  property.color = {{0.0, Rgb::Zero()}};
  property.unitDistance = GetParam().unitDistance;
  const Volume volume = makeScalarRamp();
  const RayProbe<std::int16_t> probe(volume, tabulate(property, "test"));
  // Reference: -ln(1 - opacity) / unit distance, opacity <= 0.9999, along 0.5 mm around scalar 50.
  double depth = 0.0;
  constexpr int steps = 20000;
  for (int k = 0; k < steps; ++k) {
    const double s = 50.0 + 50.0 * ((k + 0.5) / steps - 0.5) * 0.5;
    const double opacity = std::min(interpolateCurve(property.scalarOpacity, s), 0.9999);
    depth -= std::log1p(-opacity) / property.unitDistance * 0.5 / steps;
  }
  // The table's relative error is at most 1e-4.
  ASSERT_LT(depth, 8.0);
  probe.expectTransmittance({{0.2, -0.3, -0.25}, Vec3::UnitZ()}, {0.0, 0.5}, std::exp(-depth),
                            scaleSamples(20000));
}

INSTANTIATE_TEST_SUITE_P(
    Properties, PropertyExtremes,
    ::testing::Values(
        PropertyCase{"opaque", {{0.0, 1.0}}, 1.0},
        PropertyCase{"opaqueAbove", {{0.0, 0.0}, {50.0, 1.0}, {100.0, 1.0}}, 1.0},
        PropertyCase{"opaqueAtPoint", {{0.0, 0.0}, {50.0, 1.0}, {100.0, 0.0}}, 1.0},
        PropertyCase{"clear", {{0.0, 0.0}}, 1.0},
        PropertyCase{"step", {{50.0, 0.1}, {50.0, 0.7}}, 1.0},
        PropertyCase{"sharp", {{0.0, 0.1, 0.5, 1.0}, {100.0, 0.8, 0.5, 1.0}}, 1.0},
        PropertyCase{"midpointAtEnd", {{40.0, 0.1, 1.0, 0.0}, {60.0, 0.8, 0.0, 0.0}}, 1.0},
        PropertyCase{"sharpMidpoint", {{40.0, 0.1, 0.0, 0.5}, {60.0, 0.8, 0.5, 0.0}}, 1.0},
        PropertyCase{"longUnit", {{0.0, 1.0}}, 1e30},
        PropertyCase{"farNodes", {{-1e38, 0.3}, {1e38, 0.5}}, 1.0}),
    [](const auto& info) { return std::string(info.param.name); });

// ---- constant volumes

template <typename Voxel>
void expectConstantIs(double value, double sigma_t) {
  const Volume volume = makeVolume<Voxel>(makeCenteredGrid({5, 4, 3}, Vec3::Ones()),
                                          [=](const Vec3&) { return value; });
  const TransferFunction transfer{ScalarFunction({makeKnot(-1000, 0.1), makeKnot(0, 0.2),
                                                  makeKnot(0, 0.3), makeKnot(300, 0.4)}),
                                  ColorFunction({{0.0, Rgb::Ones()}})};
  const RayProbe<Voxel> probe(volume, transfer);
  probe.expectTransmittance({{-9, 0, 0}, Vec3::UnitX()}, {}, std::exp(-5.0 * sigma_t),
                            scaleSamples(10000));
  TestScene scene{volume, transfer, {EnvironmentLight{}}, {}, 8, 8};
  scene.pose.position = {10.0, -10.0, 8.0};
  scene.pose.target = Vec3::Zero();
  scene.pose.scale = 3.0;
  for (const bool hybrid : {false, true}) { // no gradient, so no surface
    if (hybrid)
      scene.transfer.shading = SurfaceShading{};
    expectRadianceOne(renderScene(scene, scaleSamples(60)));
  }
}

TEST(Classification, ConstantVolumeHasConstantExtinction) {
  expectConstantIs<std::uint8_t>(0.0, 0.3); // a step has the value of its right side
  expectConstantIs<std::int16_t>(0.0, 0.3);
  expectConstantIs<float>(0.0, 0.3);
  expectConstantIs<float>(-0.0, 0.3);
  expectConstantIs<float>(-1e-40, 0.2);
  expectConstantIs<std::int16_t>(-1000.0, 0.1);
  expectConstantIs<float>(-1000.0, 0.1);
  expectConstantIs<float>(-3e38, 0.1);
  expectConstantIs<std::uint16_t>(300.0, 0.4);
  expectConstantIs<float>(3e38, 0.4);
  expectConstantIs<std::int16_t>(150.0, 0.35);
}

} // namespace
} // namespace fenestra::core::testing::TransferStressTests
