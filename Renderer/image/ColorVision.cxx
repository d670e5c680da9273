#include "image/ColorVision.h"

#include "base/Color.h"

#include <algorithm>
#include <cmath>

namespace fenestra::core {
namespace {

/// Linear Rec. 709 to XYZ (IEC 61966-2-1), and the XYZ of its white point.
constexpr Mat3 toXyz =
    Mat3::FromRows({0.4124, 0.3576, 0.1805}, {0.2126, 0.7152, 0.0722}, {0.0193, 0.1192, 0.9505});
constexpr Vec3 white(0.9505, 1.0, 1.089);

double angleInDegrees(double y, double x) {
  const double angle = std::atan2(y, x) * 180.0 / pi;
  return angle < 0.0 ? angle + 360.0 : angle;
}

double cosDegrees(double degrees) {
  return std::cos(degrees * pi / 180.0);
}

double pow7(double x) {
  return std::pow(x, 7.0);
}

/// Chroma and hue, with a* scaled near gray (Sharma et al., eq. 2 to 7).
struct AdjustedHue {
  double C, h;

  AdjustedHue(const Lab& lab, double meanChroma) {
    const double g = 0.5 * (1.0 - std::sqrt(pow7(meanChroma) / (pow7(meanChroma) + pow7(25.0))));
    const double a = (1.0 + g) * lab.a;
    C = std::hypot(a, lab.b);
    h = C > 0.0 ? angleInDegrees(lab.b, a) : 0.0;
  }
};

/// Difference and mean of two hues along the shorter arc, degrees (eq. 10 and 14).
std::array<double, 2> hueDifferenceAndMean(const AdjustedHue& x, const AdjustedHue& y) {
  if (x.C * y.C == 0.0)
    return {0.0, x.h + y.h};
  double difference = y.h - x.h, mean = 0.5 * (x.h + y.h);
  if (std::abs(difference) > 180.0) {
    difference += difference > 0.0 ? -360.0 : 360.0;
    mean += mean < 180.0 ? 180.0 : -180.0;
  }
  return {difference, mean};
}

} // namespace

Rgb simulateVision(ColorVision vision, const Rgb& linear) {
  using Rows = std::array<Vec3, 3>;
  static const std::array<Rows, 3> matrices = {
      // protan, deutan, tritan
      Rows{Vec3(0.152286, 1.052583, -0.204868), Vec3(0.114503, 0.786281, 0.099216),
           Vec3(-0.003882, -0.048116, 1.051998)},
      Rows{Vec3(0.367322, 0.860646, -0.227968), Vec3(0.280085, 0.672501, 0.047413),
           Vec3(-0.011820, 0.042940, 0.968881)},
      Rows{Vec3(1.255528, -0.076749, -0.178779), Vec3(-0.078411, 0.930809, 0.147602),
           Vec3(0.004733, 0.691367, 0.303900)}};
  if (vision == ColorVision::normal)
    return linear;
  const Rows& rows = matrices[static_cast<std::size_t>(vision) - 1];
  const Vec3 color(linear[0], linear[1], linear[2]);
  Rgb simulated;
  for (int c = 0; c < 3; ++c)
    simulated[c] = std::clamp(rows[static_cast<std::size_t>(c)].dot(color), 0.0, 1.0);
  return simulated;
}

Lab toLab(const Rgb& linear) {
  const Vec3 xyz = toXyz * Vec3(linear[0], linear[1], linear[2]);
  const double x = xyz.x() / white.x(), y = xyz.y(), z = xyz.z() / white.z();
  const auto f = [](double t) {
    return t > 216.0 / 24389.0 ? std::cbrt(t) : (24389.0 / 27.0 * t + 16.0) / 116.0;
  };
  return {116.0 * f(y) - 16.0, 500.0 * (f(x) - f(y)), 200.0 * (f(y) - f(z))};
}

Rgb toLinear(const Lab& lab) {
  const auto t = [](double f) {
    return f > 6.0 / 29.0 ? f * f * f : (116.0 * f - 16.0) * 27.0 / 24389.0;
  };
  const double middle = (lab.L + 16.0) / 116.0;
  const Vec3 xyz =
      white.cwiseProduct(Vec3(t(middle + lab.a / 500.0), t(middle), t(middle - lab.b / 200.0)));
  static const Mat3 fromXyz = toXyz.inverse();
  return (fromXyz * xyz).array();
}

double deltaE76(const Lab& x, const Lab& y) {
  return std::hypot(x.L - y.L, x.a - y.a, x.b - y.b);
}

double deltaE2000(const Lab& x, const Lab& y) {
  const double chroma = 0.5 * (std::hypot(x.a, x.b) + std::hypot(y.a, y.b));
  const AdjustedHue first(x, chroma), second(y, chroma);
  const auto [hue, meanHue] = hueDifferenceAndMean(first, second);
  const double dL = y.L - x.L, dC = second.C - first.C;
  const double dH = 2.0 * std::sqrt(first.C * second.C) * std::sin(0.5 * hue * pi / 180.0);
  const double meanC = 0.5 * (first.C + second.C);
  const double offL2 = std::pow(0.5 * (x.L + y.L) - 50.0, 2.0);
  const double t = 1.0 - 0.17 * cosDegrees(meanHue - 30.0) + 0.24 * cosDegrees(2.0 * meanHue) +
                   0.32 * cosDegrees(3.0 * meanHue + 6.0) - 0.20 * cosDegrees(4.0 * meanHue - 63.0);
  const double rotation = 30.0 * std::exp(-std::pow((meanHue - 275.0) / 25.0, 2.0));
  const double rC = 2.0 * std::sqrt(pow7(meanC) / (pow7(meanC) + pow7(25.0)));
  const double rT = -std::sin(2.0 * rotation * pi / 180.0) * rC;
  const double l = dL / (1.0 + 0.015 * offL2 / std::sqrt(20.0 + offL2));
  const double c = dC / (1.0 + 0.045 * meanC), h = dH / (1.0 + 0.015 * meanC * t);
  return std::sqrt(std::max(0.0, l * l + c * c + h * h + rT * c * h));
}

} // namespace fenestra::core
