#pragma once
// The classified volume at a point: extinction for tracking, matter for the estimator.

#include "model/medium/ContextStyle.h"
#include "model/medium/Tint.h"
#include "model/medium/TransferFunction.h"
#include "model/volume/Volume.h"

#include <optional>

namespace fenestra {

/// Matter at a real collision, for the estimator.
struct Matter {
  Rgb albedo;
  Vec3 gradient; ///< of the scalar, with a cut's, per mm, world axes; zero unless needsGradient()
  double surfaceProbability; ///< probability that the path scatters at a surface here
};

/// A view: voxels, transfer function, style and tint must outlive the medium. Points are in index
/// space.
template <typename Voxel>
class Medium {
public:
  Medium(const Grid& grid, const std::vector<Voxel>& voxels, const TransferFunction& transfer,
         const ContextStyle* style = nullptr, const Tint* tint = nullptr)
      : m_field(grid, voxels), m_transfer(transfer) {
    if (style)
      m_context.emplace(*style, grid);
    if (tint)
      m_tinted.emplace(*tint, grid);
  }

  /// Extinction in mm^-1.
  double extinction(const Vec3& index) const {
    double sigma_t = m_transfer.extinction(m_field.value(index)).value();
    if (sigma_t != 0.0 && m_context && m_context->style().extinction != 1.0 &&
        !m_context->isFocus(index))
      sigma_t *= m_context->style().extinction;
    if (sigma_t == 0.0 || !m_transfer.gradientOpacity)
      return sigma_t;
    return sigma_t * (*m_transfer.gradientOpacity)(m_field.gradient(index).norm()).value();
  }

  bool needsGradient(bool wantGradient) const { return wantGradient || m_transfer.shading; }
  /// `wantGradient`: fills the gradient even without shading. `cut`: gradient that a cut adds where
  /// there is shading, spans of the transfer function per mm, world axes; it changes surfaces, not
  /// the extinction.
  Matter matter(const Vec3& index, bool wantGradient, const Vec3& cut = Vec3::Zero()) const {
    const bool oneAlbedo = m_transfer.albedo.knots().size() == 1 && !m_tinted;
    const double scalar = oneAlbedo && !m_transfer.shading ? 0.0 : m_field.value(index);
    Matter m{m_transfer.albedo(scalar), Vec3::Zero(), 0.0};
    if (m_tinted)
      m.albedo = m_tinted->albedo(index, scalar, m.albedo);
    if (m_context && !m_context->isFocus(index))
      m.albedo = m_context->style().paled(m.albedo);
    if (needsGradient(wantGradient))
      m.gradient = m_field.gradient(index);
    if (m_transfer.shading) {
      const double slope = m.gradient.norm();
      double sigma_t = m_transfer.extinction(scalar).value();
      if (m_transfer.gradientOpacity)
        sigma_t *= (*m_transfer.gradientOpacity)(slope).value();
      if (!cut.isZero(0.0))
        m.gradient += m_transfer.extinction.span() * cut;
      m.surfaceProbability = surfaceProbability(sigma_t, m.gradient.norm());
    }
    return m;
  }

  const TransferFunction& transfer() const { return m_transfer; }

private:
  /// Kroes, Post, Botha 2012, with opacity and gradient over 1 mm:
  /// P = o (1 - exp(-25 gamma^3 m)).
  double surfaceProbability(double sigma_t, double gradientMagnitude) const {
    const double span = m_transfer.extinction.span();
    if (!(span > 0.0))
      return 0.0; // one knot: no scale to call a gradient large
    const double gamma = m_transfer.shading->gamma;
    const double opacity = -std::expm1(-sigma_t);
    const double m = gradientMagnitude / span;
    return opacity * -std::expm1(-25.0 * gamma * gamma * gamma * m);
  }

  Field<Voxel> m_field;
  const TransferFunction& m_transfer;
  std::optional<StyledContext> m_context;
  std::optional<TintedField> m_tinted;
};

} // namespace fenestra
