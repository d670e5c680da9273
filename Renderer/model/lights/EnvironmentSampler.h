#pragma once
// Environment radiance: a constant, or a latitude-longitude map with constant texels that is
// importance sampled by brightness times solid angle.

#include "model/lights/Light.h"

namespace fenestra::core {

class EnvironmentSampler {
public:
  explicit EnvironmentSampler(EnvironmentLight light);

  /// Samples a unit direction toward the environment with density pdf().
  Vec3 sample(const Vec2& u) const;
  Rgb radiance(const Vec3& direction) const;
  double pdf(const Vec3& direction) const;
  /// Mean radiance over the sphere.
  const Rgb& mean() const { return m_mean; }

  const EnvironmentLight& light() const { return m_light; }
  /// Integral of the map's brightness over the sphere; 0 for a constant.
  double integral() const { return m_integral; }
  /// Cumulative probabilities of the rows: 0, ..., 1; all 0 if the map is black.
  const std::vector<double>& rowCdf() const { return m_rowCdf; }
  /// Cumulative probabilities of the texels in a row, likewise.
  const std::vector<double>& columnCdf(int row) const {
    return m_columnCdf[static_cast<std::size_t>(row)];
  }

  bool isConstant() const { return m_light.map.width == 0; }

private:
  std::size_t texelIndex(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(m_light.map.width) +
           static_cast<std::size_t>(column);
  }
  std::size_t findTexel(const Vec3& direction) const;
  Rgb texel(std::size_t index) const;
  double texelPdf(std::size_t index) const;

  EnvironmentLight m_light;
  Rgb m_mean = Rgb::Zero();
  std::vector<double> m_rowCdf;                 ///< height + 1 entries, last 1
  std::vector<std::vector<double>> m_columnCdf; ///< width + 1 entries per row
  double m_integral = 0.0;
};

} // namespace fenestra::core
