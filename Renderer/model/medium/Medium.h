#pragma once
// The classified volume: extinction for tracking, and optical properties at collisions.

#include "base/Random.h"
#include "model/medium/ContextStyle.h"
#include "model/medium/Mixture.h"
#include "model/medium/Scattering.h"
#include "model/medium/Tint.h"
#include "model/medium/TransferFunction.h"
#include "model/volume/Field.h"

#include <optional>

namespace fenestra::core {

/// Optical properties at a real collision.
struct MediumSample {
  Rgb albedo;
  Vec3 gradient;             ///< of scalar and cut, per mm, world axes; zero unless needsGradient()
  double surfaceProbability; ///< probability that the path scatters at a surface here
  const TransferFunction* transfer; ///< for the phase function and surface shading
};

/// A view: the arguments of the constructor, except the grid, must outlive it. Points are in index
/// space. With a mixture, `transfer` is the volume's own function, and there is no tint.
template <typename Voxel>
class Medium {
public:
  Medium(const Grid& grid, std::span<const Voxel> voxels, const TransferFunction& transfer,
         const ContextStyle* style = nullptr, const Tint* tint = nullptr,
         const Mixture* mixture = nullptr)
      : m_field(grid, voxels), m_transfer(transfer) {
    if (style)
      m_context.emplace(*style, grid);
    if (tint)
      m_tint.emplace(*tint, grid);
    if (mixture)
      m_mixture.emplace(*mixture, grid);
  }

  /// True if the extinction may be above 0 where the clip weight is `clipWeight`.
  bool canCollide(double clipWeight) const {
    return clipWeight > 0.0 || (m_mixture && m_mixture->hasUnclipped());
  }
  /// Extinction, mm^-1, under a clip weight.
  double extinction(const Vec3& index, double clipWeight = 1.0) const {
    if (m_mixture)
      return contextFactor(index) * m_mixture->extinction(makePoint(index, clipWeight));
    double sigma_t = m_transfer.extinction(m_field.value(index)).value();
    if (sigma_t != 0.0)
      sigma_t *= contextFactor(index);
    if (sigma_t != 0.0 && m_transfer.gradientOpacity)
      sigma_t *= (*m_transfer.gradientOpacity)(opacitySlope(index)).value();
    return clipWeight * sigma_t;
  }

  bool needsGradient(bool wantGradient) const { return wantGradient || m_transfer.shading; }
  const TransferFunction& transfer() const { return m_transfer; }
  /// Null: there is no mixture, and the volume's transfer function applies everywhere.
  const MixtureField* mixtureField() const { return m_mixture ? &*m_mixture : nullptr; }
  const Mixture* mixture() const { return m_mixture ? &m_mixture->mixture() : nullptr; }

  /// Sample of a medium without a mixture. `wantGradient`: computes the gradient even without
  /// shading. `cut`: gradient that the clip's cut adds under shading, in spans of the transfer
  /// function per mm, world axes; it affects surfaces, not the extinction.
  MediumSample evaluate(const Vec3& index, bool wantGradient,
                        const Vec3& cut = Vec3::Zero()) const {
    const bool oneAlbedo = m_transfer.albedo.knots().size() == 1 && !m_tint;
    const double scalar = oneAlbedo && !m_transfer.shading ? 0.0 : m_field.value(index);
    Rgb albedo = m_transfer.albedo(scalar);
    if (m_tint)
      albedo = m_tint->albedo(index, scalar, albedo);
    return makeSample(m_transfer, albedo, index, scalar, wantGradient, cut);
  }
  /// Sample of one component of the mixture.
  MediumSample evaluate(std::uint8_t number, const MixturePoint& point, bool wantGradient,
                        const Vec3& cut = Vec3::Zero()) const {
    const Component& component = m_mixture->mixture().components[number];
    const Vec3 interface =
        component.interfaceWeight > 0.0 && component.transfer.shading
            ? Vec3(component.interfaceWeight * m_mixture->weightGradient(number, point.index))
            : Vec3::Zero();
    return makeSample(component.transfer, component.transfer.albedo(point.scalar), point.index,
                      point.scalar, wantGradient,
                      interface + (component.isClipped ? cut : Vec3::Zero()));
  }
  /// Evaluates the values that the mixture's parts at a point depend on.
  MixturePoint makePoint(const Vec3& index, double clipWeight) const {
    const double slope = m_mixture->needsGradient() ? opacitySlope(index) : 0.0;
    return {index, m_field.value(index), clipWeight, slope};
  }

private:
  Vec3 shadingGradient(const Vec3& index) const {
    return m_transfer.gradient == GradientKind::sobel ? m_field.sobelGradient(index)
                                                      : m_field.gradient(index);
  }
  /// |gradient| for gradient opacity.
  double opacitySlope(const Vec3& index) const { return m_field.gradient(index).norm(); }

  /// The context style's factor on the extinction.
  double contextFactor(const Vec3& index) const {
    return m_context && m_context->style().extinction != 1.0 && !m_context->isFocus(index)
               ? m_context->style().extinction
               : 1.0;
  }

  /// `extraGradient`: added to the scalar gradient, in spans of the volume's own extinction per mm.
  MediumSample makeSample(const TransferFunction& transfer, const Rgb& albedo, const Vec3& index,
                          double scalar, bool wantGradient, const Vec3& extraGradient) const {
    MediumSample m{albedo, Vec3::Zero(), 0.0, &transfer};
    if (m_context && !m_context->isFocus(index))
      m.albedo = m_context->style().desaturate(m.albedo);
    if (wantGradient || transfer.shading)
      m.gradient = shadingGradient(index);
    if (transfer.shading) {
      double sigma_t = transfer.extinction(scalar).value();
      if (transfer.gradientOpacity)
        sigma_t *= (*transfer.gradientOpacity)(opacitySlope(index)).value();
      if (!extraGradient.isZero(0.0))
        m.gradient += m_transfer.extinction.span() * extraGradient;
      const double span = m_transfer.extinction.span();
      if (span > 0.0) // else one knot: there is no scale for gradients
        m.surfaceProbability = scalar::surfaceProbability(
            sigma_t, 25.0 * std::pow(transfer.shading->gamma, 3), m.gradient.norm() / span);
    }
    return m;
  }

  Field<Voxel> m_field;
  const TransferFunction& m_transfer;
  std::optional<ContextField> m_context;
  std::optional<TintField> m_tint;
  std::optional<MixtureField> m_mixture;
};

template <typename Voxels, typename... More>
Medium(const Grid&, const Voxels&, const More&...) -> Medium<typename Voxels::value_type>;

} // namespace fenestra::core
