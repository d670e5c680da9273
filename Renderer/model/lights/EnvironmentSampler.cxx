#include "model/lights/EnvironmentSampler.h"

#include "base/ScalarMath.h"

#include "base/Random.h"

namespace fenestra::core::scalar {
#include "formulas/Environment.inl"
} // namespace fenestra::core::scalar

namespace fenestra::core {
namespace {

struct CdfSample {
  int index;
  double remainder; ///< position inside the bin, [0, 1)
};

/// Finds the bin that contains u in a cumulative table (0 first, 1 last). Bins of probability 0 are
/// never selected.
CdfSample sampleCdf(const std::vector<double>& cdf, double u) {
  auto above = std::ranges::upper_bound(cdf, u);
  if (above == cdf.end()) // rounding: use the last bin of probability > 0
    above = std::ranges::lower_bound(cdf, cdf.back());
  const auto index = static_cast<std::size_t>(std::max<std::ptrdiff_t>(0, above - cdf.begin() - 1));
  const double width = cdf[index + 1] - cdf[index];
  const double remainder = width > 0.0 ? (u - cdf[index]) / width : 0.5;
  return {static_cast<int>(index), std::clamp(remainder, 0.0, std::nextafter(1.0, 0.0))};
}

/// Builds the cumulative table of weight(bin), 0 first and 1 last; returns the weights' sum.
double buildCdf(std::vector<double>& cdf, int bins, const auto& weight) {
  cdf = {0.0};
  for (int i = 0; i < bins; ++i)
    cdf.push_back(cdf.back() + weight(i));
  const double sum = cdf.back();
  if (sum > 0.0)
    for (double& value : cdf)
      value /= sum;
  return sum;
}

} // namespace

EnvironmentSampler::EnvironmentSampler(EnvironmentLight light) : m_light(std::move(light)) {
  if (isConstant()) {
    m_mean = m_light.radiance;
    return;
  }
  const int width = m_light.map.width;
  const int height = m_light.map.height;
  const auto rowWeight = [&](int row) {
    const double solidAngle = // of one texel
        2.0 * pi / width * (std::cos(pi * row / height) - std::cos(pi * (row + 1) / height));
    const auto texelWeight = [&](int column) {
      const Rgb value = texel(texelIndex(column, row));
      m_mean += value * (solidAngle / (4.0 * pi));
      return brightness(value);
    };
    return buildCdf(m_columnCdf.emplace_back(), width, texelWeight) * solidAngle;
  };
  m_integral = buildCdf(m_rowCdf, height, rowWeight);
}

Rgb EnvironmentSampler::texel(std::size_t index) const {
  const float* rgb = &m_light.map.rgb[3 * index];
  return m_light.radiance * Rgb(rgb[0], rgb[1], rgb[2]);
}

std::size_t EnvironmentSampler::findTexel(const Vec3& d) const {
  const double width = m_light.map.width, height = m_light.map.height;
  return texelIndex(scalar::texelOnAxis(scalar::columnOfDirection(d, width), width),
                    scalar::texelOnAxis(scalar::rowOfDirection(d, height), height));
}

double EnvironmentSampler::texelPdf(std::size_t index) const {
  return m_integral > 0.0 ? brightness(texel(index)) / m_integral : 0.0;
}

Rgb EnvironmentSampler::radiance(const Vec3& direction) const {
  return isConstant() ? m_light.radiance : texel(findTexel(direction));
}

double EnvironmentSampler::pdf(const Vec3& direction) const {
  return isConstant() ? 0.25 / pi : texelPdf(findTexel(direction));
}

Vec3 EnvironmentSampler::sample(const Vec2& u) const {
  if (isConstant())
    return sampleUniformSphere(u);
  const int width = m_light.map.width;
  const int height = m_light.map.height;
  const CdfSample row = sampleCdf(m_rowCdf, u.x());
  const CdfSample column = sampleCdf(m_columnCdf[static_cast<std::size_t>(row.index)], u.y());

  const double top = std::cos(pi * row.index / height);
  const double bottom = std::cos(pi * (row.index + 1) / height);
  const double z = top + (bottom - top) * row.remainder;
  const double turns = (column.index + column.remainder) / width;
  return toVector(scalar::directionInTexel(turns, 1.0 - std::abs(z), z < 0.0));
}

} // namespace fenestra::core
