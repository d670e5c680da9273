#include "model/lights/EnvironmentSampler.h"

#include "base/Random.h"

namespace fenestra {
namespace {

struct Pick {
  int index;
  double remainder; ///< position inside the picked bin, [0, 1)
};

/// Picks the bin that contains u from a cumulative table of `bins + 1` entries (0 first, 1 last);
/// bins of probability 0 are never picked.
Pick pick(const double* cdf, int bins, double u) {
  const double* end = cdf + bins + 1;
  const double* above = std::upper_bound(cdf, end, u);
  if (above == end) // only by rounding: the last bin of probability > 0
    above = std::lower_bound(cdf, end, cdf[bins]);
  const int index = std::max(0, static_cast<int>(above - cdf) - 1);
  const double width = cdf[index + 1] - cdf[index];
  const double remainder = width > 0.0 ? (u - cdf[index]) / width : 0.5;
  return {index, std::clamp(remainder, 0.0, std::nextafter(1.0, 0.0))};
}

/// Turns weights into a cumulative table in place, cdf[0] = 0 … cdf[bins] = 1; returns their sum.
double accumulate(double* cdf, int bins, const auto& weight) {
  cdf[0] = 0.0;
  for (int i = 0; i < bins; ++i)
    cdf[i + 1] = cdf[i] + weight(i);
  const double sum = cdf[bins];
  if (sum > 0.0)
    for (int i = 1; i <= bins; ++i)
      cdf[i] /= sum;
  return sum;
}

} // namespace

EnvironmentSampler::EnvironmentSampler(EnvironmentLight light) : m_light(std::move(light)) {
  if (constant()) {
    m_mean = m_light.radiance;
    return;
  }
  const int width = m_light.map.width;
  const int height = m_light.map.height;
  m_rowSolidAngle.resize(static_cast<std::size_t>(height));
  m_rowCdf.resize(static_cast<std::size_t>(height) + 1);
  m_columnCdf.resize((static_cast<std::size_t>(width) + 1) * static_cast<std::size_t>(height));

  const auto rowWeight = [&](int row) {
    const double solidAngle =
        2.0 * pi / width * (std::cos(pi * row / height) - std::cos(pi * (row + 1) / height));
    m_rowSolidAngle[static_cast<std::size_t>(row)] = solidAngle;
    double* cdf =
        &m_columnCdf[(static_cast<std::size_t>(width) + 1) * static_cast<std::size_t>(row)];
    const auto texelWeight = [&](int column) {
      const Rgb value = texel(texelIndex(column, row));
      m_mean += value * (solidAngle / (4.0 * pi));
      return brightness(value);
    };
    return accumulate(cdf, width, texelWeight) * solidAngle;
  };
  m_total = accumulate(m_rowCdf.data(), height, rowWeight);
}

Rgb EnvironmentSampler::texel(std::size_t index) const {
  const float* rgb = &m_light.map.rgb[3 * index];
  return m_light.radiance * Rgb(rgb[0], rgb[1], rgb[2]);
}

/// Design, section 1: u = 1/2 + atan2(d_R, d_A) / 2 pi, v = acos(d_S) / pi from the top.
std::size_t EnvironmentSampler::texelToward(const Vec3& d) const {
  const int width = m_light.map.width;
  const int height = m_light.map.height;
  const double u = 0.5 + std::atan2(d.x(), d.y()) / (2.0 * pi);
  const double v = std::acos(std::clamp(d.z(), -1.0, 1.0)) / pi;
  return texelIndex(std::min(static_cast<int>(u * width), width - 1),
                    std::min(static_cast<int>(v * height), height - 1));
}

double EnvironmentSampler::texelPdf(std::size_t index) const {
  return m_total > 0.0 ? brightness(texel(index)) / m_total : 0.0;
}

Rgb EnvironmentSampler::radiance(const Vec3& direction) const {
  return constant() ? m_light.radiance : texel(texelToward(direction));
}

double EnvironmentSampler::pdf(const Vec3& direction) const {
  return constant() ? 0.25 / pi : texelPdf(texelToward(direction));
}

Vec3 EnvironmentSampler::sample(const Vec2& u) const {
  if (constant())
    return uniformDirection(u);
  const int width = m_light.map.width;
  const int height = m_light.map.height;
  const Pick row = pick(m_rowCdf.data(), height, u.x());
  const Pick column = pick(
      &m_columnCdf[(static_cast<std::size_t>(width) + 1) * static_cast<std::size_t>(row.index)],
      width, u.y());

  // Uniform in solid angle inside the texel: uniform in cos(theta) and phi.
  const double top = std::cos(pi * row.index / height);
  const double bottom = std::cos(pi * (row.index + 1) / height);
  const double z = top + (bottom - top) * row.remainder;
  const double sine = std::sqrt(std::max(0.0, 1.0 - z * z));
  const double phi = 2.0 * pi * ((column.index + column.remainder) / width - 0.5);
  return {sine * std::sin(phi), sine * std::cos(phi), z};
}

} // namespace fenestra
