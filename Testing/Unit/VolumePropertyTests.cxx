// Tabulated transfer functions compared with the formulas that they approximate.

#include "Curves.h"
#include "base/Error.h"

#include <gtest/gtest.h>

#include <random>

namespace fenestra::core::VolumePropertyTests {
namespace {

VolumeProperty makeProperty(std::vector<OpacityNode> opacity) {
  VolumeProperty p;
  p.scalarOpacity = std::move(opacity);
  p.color = {{0.0, {0.2, 0.4, 0.6}}};
  return p;
}

double evalExtinction(const VolumeProperty& p, double x) {
  return -std::log1p(-std::min(interpolateCurve(p.scalarOpacity, x), 0.9999)) / p.unitDistance;
}

/// Largest relative error of the tabulated extinction. Absolute errors up to 1e-9 of its maximum
/// are ignored.
double findMaxExtinctionError(const VolumeProperty& p, const TransferFunction& f) {
  const double low = p.scalarOpacity.front().x, high = p.scalarOpacity.back().x;
  double maximum = 0.0;
  for (const OpacityNode& node : p.scalarOpacity)
    maximum = std::max(maximum, evalExtinction(p, node.x));
  double maxError = 0.0;
  constexpr int steps = 400'000;
  for (int i = -10; i <= steps + 10; ++i) {
    const double x = low + (high - low) * (i + 0.37) / steps;
    const double expected = evalExtinction(p, x);
    const double error = std::abs(f.extinction(x)[0] - expected);
    if (error > 1e-9 * maximum)
      maxError = std::max(maxError, error / expected);
  }
  return maxError;
}

/// Port of vtkPiecewiseFunction::GetTable, between two nodes.
double evalVtkCurve(const OpacityNode& a, const OpacityNode& b, double x) {
  const double m = std::clamp(a.midpoint, 0.00001, 0.99999);
  double s = (x - a.x) / (b.x - a.x);
  s = s < m ? 0.5 * s / m : 0.5 + 0.5 * (s - m) / (1.0 - m);
  if (a.sharpness > 0.99)
    return s < 0.5 ? a.value : b.value;
  if (a.sharpness < 0.01)
    return (1 - s) * a.value + s * b.value;
  if (s < .5)
    s = 0.5 * std::pow(s * 2, 1.0 + 10 * a.sharpness);
  else if (s > .5)
    s = 1.0 - 0.5 * std::pow((1.0 - s) * 2, 1 + 10 * a.sharpness);
  const double ss = s * s, sss = ss * s;
  const double h1 = 2 * sss - 3 * ss + 1, h2 = -2 * sss + 3 * ss;
  const double h3 = sss - 2 * ss + s, h4 = sss - ss;
  const double t = (1.0 - a.sharpness) * (b.value - a.value);
  return std::clamp(h1 * a.value + h2 * b.value + h3 * t + h4 * t, std::min(a.value, b.value),
                    std::max(a.value, b.value));
}

TEST(VolumeProperty, InterpolatesLikeVtk) {
  for (const double midpoint : {0.0, 1e-3, 0.3, 0.5, 0.9, 1.0})
    for (const double sharpness : {0.0, 0.009, 0.01, 0.3, 0.5, 0.99, 0.995, 1.0}) {
      const std::vector<OpacityNode> nodes = {{-100, 0.8, midpoint, sharpness}, {300, 0.1}};
      for (double x = -99.7; x < 300; x += 1.1)
        ASSERT_NEAR(interpolateCurve(nodes, x), evalVtkCurve(nodes[0], nodes[1], x), 1e-14)
            << midpoint << " " << sharpness << " at " << x;
      EXPECT_EQ(interpolateCurve(nodes, -200), 0.8);
      EXPECT_EQ(interpolateCurve(nodes, 300), 0.1);
      EXPECT_EQ(interpolateCurve(nodes, 400), 0.1);
    }
}

TEST(VolumeProperty, ColorsInterpolateLikeOpacity) {
  const std::vector<ColorNode> nodes = {{0, {0, 0.5, 1}, 0.3, 0.4}, {10, {1, 0.25, 0.5}}};
  const std::vector<OpacityNode> red = {{0, 0, 0.3, 0.4}, {10, 1}};
  for (double x = -1; x < 12; x += 0.1) {
    const double fraction = interpolateCurve(red, x);
    EXPECT_NEAR(interpolateCurve(nodes, x)[0], fraction, 1e-14);
    EXPECT_NEAR(interpolateCurve(nodes, x)[1], 0.5 - 0.25 * fraction, 1e-14);
    EXPECT_NEAR(interpolateCurve(nodes, x)[2], 1.0 - 0.5 * fraction, 1e-14);
  }
}

TEST(VolumeProperty, DecodesSrgb) {
  const Rgb linear = decodeSrgb({0.04045, 0.5, 1.0});
  EXPECT_NEAR(linear[0], 0.04045 / 12.92, 1e-15);
  EXPECT_NEAR(linear[1], 0.21404114, 1e-8);
  EXPECT_NEAR(linear[2], 1.0, 1e-15);
}

TEST(VolumeProperty, EncodingIsTheInverseOfDecoding) {
  for (const double v : {0.0, 0.001, 0.04045, 0.041, 0.3, 1.0})
    EXPECT_NEAR(encodeSrgb(decodeSrgb(Rgb::Constant(v)))[1], v, 1e-14) << v;
}

TEST(VolumeProperty, ExtinctionIsWithin1e4OfTheFormula) {
  const std::vector<std::vector<OpacityNode>> curves = {
      {{0, 0}, {1, 1}},
      {{0, 1}, {1, 0}},
      {{0, 0}, {1, 1e-7}},
      {{-1000, 0}, {0, 1e-4}, {1, 0.9999}, {2, 1}, {3000, 0.5}},
      {{0, 0.3}, {1e-6, 0.9}, {1000, 0.31}},
      {{5, 0.25}},
  };
  for (const auto& nodes : curves)
    for (const double unit : {1.0, 0.01, 40.0}) {
      VolumeProperty p = makeProperty(nodes);
      p.unitDistance = unit;
      const TransferFunction f = tabulate(p, "test");
      EXPECT_LE(findMaxExtinctionError(p, f), 1e-4);
      EXPECT_LE(f.extinction.knots().size(), 6000u);
    }
}

TEST(VolumeProperty, ExtinctionOfSharpCurvesIsWithin1e4OfTheFormula) {
  for (const double midpoint : {0.0, 0.1, 0.5, 1.0})
    for (const double sharpness : {0.01, 0.1, 0.5, 0.99}) {
      const VolumeProperty p = makeProperty({{-200, 0, midpoint, sharpness}, {1000, 1}});
      const TransferFunction f = tabulate(p, "test");
      EXPECT_LE(findMaxExtinctionError(p, f), 1e-4) << midpoint << " " << sharpness;
      EXPECT_LE(f.extinction.knots().size(), 6000u);
    }
}

TEST(VolumeProperty, EveryNodeIsAKnot) {
  const VolumeProperty p = makeProperty({{-7, 0.1}, {0.1, 0.7}, {13, 0.2}});
  const TransferFunction f = tabulate(p, "test");
  for (const OpacityNode& node : p.scalarOpacity)
    EXPECT_DOUBLE_EQ(f.extinction(node.x)[0], -std::log1p(-node.value));
}

TEST(VolumeProperty, StepsStayDiscontinuous) {
  const TransferFunction sharp = tabulate(makeProperty({{0, 0.2, 0.25, 1.0}, {8, 0.6}}), "test");
  EXPECT_DOUBLE_EQ(sharp.extinction(1.999)[0], -std::log1p(-0.2));
  EXPECT_DOUBLE_EQ(sharp.extinction(2.0)[0], -std::log1p(-0.6));
  const TransferFunction coincident =
      tabulate(makeProperty({{0, 0}, {4, 0.2}, {4, 0.6}, {8, 1}}), "");
  EXPECT_NEAR(coincident.extinction(4 - 1e-9)[0], -std::log1p(-0.2), 1e-6);
  EXPECT_DOUBLE_EQ(coincident.extinction(4)[0], -std::log1p(-0.6));
}

TEST(VolumeProperty, FullOpacityIsCapped) {
  const TransferFunction f = tabulate(makeProperty({{0, 0}, {1, 1}}), "test");
  EXPECT_NEAR(f.extinction(1)[0], -std::log(0.0001), 1e-12);
  EXPECT_NEAR(f.extinction(0.99995)[0], -std::log(0.0001), 1e-12);
}

TEST(VolumeProperty, AlbedoIsWithin1e4OfTheDecodedColor) {
  VolumeProperty p = makeProperty({{0, 0.5}});
  p.color = {{0, {0, 0.5, 1}, 0.3, 0.6}, {10, {1, 0.001, 0.02}}, {11, {0, 0, 0}}};
  const TransferFunction f = tabulate(p, "test");
  for (double x = -1; x < 12; x += 1e-4) {
    const Rgb expected = decodeSrgb(interpolateCurve(p.color, x));
    ASSERT_TRUE(((f.albedo(x) - expected).abs() <= 1e-4 * expected + 1e-9).all()) << x;
  }
  EXPECT_LE(f.albedo.knots().size(), 6010u);
}

TEST(VolumeProperty, NumberOfKnotsIsBounded) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform;
  VolumeProperty p;
  for (int i = 0; i < 2000; ++i) {
    p.scalarOpacity.push_back({double(i), uniform(random), uniform(random), uniform(random)});
    p.color.push_back({double(i), Rgb(uniform(random), 0, 1), 0.5, uniform(random)});
  }
  const TransferFunction f = tabulate(p, "test");
  EXPECT_LE(f.extinction.knots().size(), 14'000u);
  EXPECT_LE(f.albedo.knots().size(), 14'000u);
}

TEST(VolumeProperty, OmitsGradientOpacityOfOne) {
  VolumeProperty p = makeProperty({{0, 0.5}});
  p.gradientOpacity = {{0, 1}, {255, 1}};
  EXPECT_FALSE(tabulate(p, "test").gradientOpacity);
  p.gradientOpacity = {{0, 0}, {255, 1}};
  const TransferFunction f = tabulate(p, "test");
  ASSERT_TRUE(f.gradientOpacity);
  EXPECT_DOUBLE_EQ((*f.gradientOpacity)(51)[0], 0.2);
}

TEST(VolumeProperty, ShadeEnablesShading) {
  VolumeProperty p = makeProperty({{0, 0.5}});
  EXPECT_FALSE(tabulate(p, "test").shading);
  p.shade = true;
  p.specularPower = 30.0;
  ASSERT_TRUE(tabulate(p, "test").shading);
  EXPECT_EQ(tabulate(p, "test").shading->power, 30.0);
}

TEST(VolumeProperty, RefusesInvalidValues) {
  const auto expectRefused = [](auto&& change) {
    VolumeProperty p = makeProperty({{0, 0}, {1, 0.5}});
    change(p);
    EXPECT_THROW(tabulate(p, "test"), Error);
  };
  expectRefused([](VolumeProperty& p) { p.scalarOpacity.clear(); });
  expectRefused([](VolumeProperty& p) { p.color.clear(); });
  expectRefused([](VolumeProperty& p) { p.scalarOpacity[1].value = 1.5; });
  expectRefused([](VolumeProperty& p) { p.scalarOpacity[1].x = std::nan(""); });
  expectRefused([](VolumeProperty& p) { p.scalarOpacity[1].x = -1.0; });
  expectRefused([](VolumeProperty& p) { p.scalarOpacity[0].sharpness = 2.0; });
  expectRefused([](VolumeProperty& p) { p.color[0].value[1] = -0.1; });
  expectRefused([](VolumeProperty& p) { p.unitDistance = 0.0; });
  expectRefused([](VolumeProperty& p) { p.anisotropy = 1.0; });
  expectRefused([](VolumeProperty& p) { p.specularPower = -1.0; });
}

} // namespace
} // namespace fenestra::core::VolumePropertyTests
