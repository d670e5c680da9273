#include "model/medium/CoatReflectance.h"

#include "model/medium/Scattering.h"

#include <Eigen/Dense>

namespace fenestra::core {
namespace {

/// Directional albedo of the GGX lobe: mean weight of its samples on a regular grid. There is no
/// other lobe, so the number that selects one has no effect.
double estimateReflectance(const SurfaceShading& ggx, double cosine) {
  constexpr int strata = 32;
  const Vec3 incoming(-std::sqrt(1.0 - cosine * cosine), 0.0, -cosine);
  const scalar::SurfaceLobes surface =
      scalar::makeSurfaceLobes(makeBsdf(0.0, ggx), incoming, -Vec3::UnitZ(), Rgb::Zero());
  double sum = 0.0;
  for (int i = 0; i < strata; ++i)
    for (int j = 0; j < strata; ++j)
      sum += scalar::sampleLobe(surface, 0.5, (i + 0.5) / strata, (j + 0.5) / strata).weight.x;
  return sum / (strata * strata);
}

} // namespace

CoatReflectance fitCoatReflectance(double roughness) {
  constexpr int angles = 40;
  const SurfaceShading ggx{.diffuse = 0.0,
                           .specular = 1.0,
                           .power = 2.0 / (roughness * roughness) - 2.0,
                           .coated = CoatReflectance()};
  Eigen::Matrix<double, angles, 4> powers;
  Eigen::Vector<double, angles> reflected, weights;
  for (int i = 0; i < angles; ++i) {
    const double cosine = (i + 0.5) / angles, x = 1.0 - cosine;
    reflected[i] = estimateReflectance(ggx, cosine);
    powers.row(i) << 1.0, std::pow(x, 2), std::pow(x, 4), std::pow(x, 8);
    weights[i] = std::sqrt(cosine); // squared errors are weighted by the cosine
  }
  const Eigen::Vector4d fit =
      (weights.asDiagonal() * powers).colPivHouseholderQr().solve(weights.asDiagonal() * reflected);
  // Raises the fit to at least the reflectance at all angles.
  const double missing = (reflected - powers * fit).maxCoeff();
  return {fit[0] + std::max(0.0, missing), fit[1], fit[2], fit[3]};
}

} // namespace fenestra::core
