#include "session/Contrast.h"

#include "base/Color.h"
#include "files/pictures/DisplayTransform.h"
#include "model/medium/ContextStyle.h"
#include "model/medium/Reflectance.h"

#include <algorithm>

namespace fenestra {
namespace {

/// Every n-th of the values added, n a power of two, so that some ten thousand are left.
class Thinned {
public:
  void add(double value) {
    if (m_count++ % m_stride != 0)
      return;
    m_values.push_back(value);
    if (m_values.size() < most)
      return;
    for (std::size_t i = 0; 2 * i < m_values.size(); ++i)
      m_values[i] = m_values[2 * i];
    m_values.resize(m_values.size() / 2);
    m_stride *= 2;
  }
  const std::vector<double>& values() const { return m_values; }

private:
  static constexpr std::size_t most = 1 << 15;

  std::vector<double> m_values;
  std::size_t m_count = 0, m_stride = 1;
};

/// Samples of the volume to both sides of the faces between voxels of the focus and others.
template <typename Voxel>
class BorderSamples {
public:
  BorderSamples(const Mask& focus, const Volume& volume, const std::vector<Voxel>& voxels,
                const TransferFunction& transfer)
      : m_focus(focus),
        m_field(volume.grid, voxels),
        m_box(volume.grid.indexBox()),
        m_toVolume(volume.grid.worldToIndex * focus.grid.indexToWorld),
        m_transfer(transfer) {}

  /// Visits faces of at most about `mostVoxels` of the mask's voxels, spread over its rows.
  BorderScalars scalars() {
    constexpr double mostVoxels = 4e6;
    const Size3& size = m_focus.grid.size;
    const double surplus = static_cast<double>(m_focus.voxels.size()) / mostVoxels;
    const auto stride = static_cast<std::int64_t>(std::ceil(std::sqrt(std::max(1.0, surplus))));
    for (std::int64_t z = 0; z < size.z(); z += stride)
      for (std::int64_t y = 0; y < size.y(); y += stride)
        for (std::int64_t x = 0; x < size.x(); ++x)
          if (isInside({x, y, z}))
            visitFaces({x, y, z});
    return {m_inner.values(), m_outer.values()};
  }

private:
  bool isInside(const Size3& voxel) const {
    for (int axis = 0; axis < 3; ++axis)
      if (voxel[axis] < 0 || voxel[axis] >= m_focus.grid.size[axis])
        return false;
    return m_focus.voxels[numberOf(voxel, m_focus.grid.size)] >= m_focus.half();
  }

  void visitFaces(const Size3& voxel) {
    for (int axis = 0; axis < 3; ++axis)
      for (const std::int64_t way : {-1, 1}) {
        Size3 step = Size3::Zero();
        step[axis] = way;
        if (!isInside(voxel + step))
          sampleAcross(voxel, step);
      }
  }

  /// Takes voxels of one kind each, up to the shell's depth or the first of the other kind.
  void sampleAcross(const Size3& voxel, const Size3& step) {
    constexpr std::int64_t shell = 3; // voxels
    for (std::int64_t k = 0; k < shell && isInside(voxel - k * step); ++k)
      sample(voxel - k * step, m_inner);
    for (std::int64_t k = 1; k <= shell && !isInside(voxel + k * step); ++k)
      sample(voxel + k * step, m_outer);
  }

  void sample(const Size3& voxel, Thinned& into) const {
    const Vec3 index = m_toVolume * voxel.cast<double>();
    if (index != Vec3(index.cwiseMax(m_box.lower).cwiseMin(m_box.upper)))
      return;
    const double value = m_field.value(index);
    if (m_transfer.extinction(value)[0] > 0.0)
      into.add(value);
  }

  const Mask& m_focus;
  Field<Voxel> m_field;
  Box m_box;
  Affine m_toVolume;
  const TransferFunction& m_transfer;
  Thinned m_inner, m_outer;
};

/// Display light, linear, of thick matter: the mean over scalars of `albedoOf` their albedo.
template <typename AlbedoOf>
Rgb displayed(const std::vector<double>& scalars, double g, const AlbedoOf& albedoOf) {
  constexpr double light = 1.1;
  Rgb sum = Rgb::Zero();
  for (const double scalar : scalars)
    sum += Rgb(albedoOf(scalar)).unaryExpr([g](double albedo) { return reflectance(albedo, g); });
  std::vector<float> pixel(4, 1.0F);
  for (int c = 0; c < 3; ++c)
    pixel[static_cast<std::size_t>(c)] =
        static_cast<float>(light * sum[c] / static_cast<double>(scalars.size()));
  pixel = toDisplay(pixel, {DisplayView::film});
  return decodeSrgb(Rgb(double{pixel[0]}, double{pixel[1]}, double{pixel[2]}));
}

} // namespace

double Contrast::share() const {
  constexpr double normal = 20.0, colorBlind = 12.0;
  return std::min({deltaE[0] / normal, deltaE[1] / colorBlind, deltaE[2] / colorBlind});
}

BorderScalars borderScalars(const Mask& focus, const Volume& volume,
                            const TransferFunction& transfer) {
  return std::visit(
      [&](const auto& voxels) { return BorderSamples(focus, volume, voxels, transfer).scalars(); },
      volume.voxels);
}

Contrast contrastAt(const BorderScalars& border, const TransferFunction& transfer,
                    double saturation) {
  const ContextStyle style{.focus = nullptr, .saturation = saturation};
  const Rgb focus =
      displayed(border.focus, transfer.g, [&](double scalar) { return transfer.albedo(scalar); });
  const Rgb context = displayed(border.context, transfer.g, [&](double scalar) {
    return style.paled(transfer.albedo(scalar));
  });
  Contrast contrast = {};
  for (const ColorSight sight : colorSights)
    contrast.deltaE[static_cast<std::size_t>(sight)] =
        deltaE2000(labOf(seenBy(sight, focus)), labOf(seenBy(sight, context)));
  contrast.deltaL = std::abs(labOf(focus).L - labOf(context).L);
  return contrast;
}

FocusContrast chosenContrast(const std::optional<double>& asked, const Mask& focus,
                             const Volume& volume, const TransferFunction& transfer) {
  const BorderScalars border = borderScalars(focus, volume, transfer);
  if (border.focus.empty() || border.context.empty())
    return {asked.value_or(1.0)};
  const auto at = [&](double saturation) {
    return FocusContrast{saturation, contrastAt(border, transfer, saturation)};
  };
  FocusContrast best = at(asked.value_or(1.0));
  if (asked)
    return best;
  for (const double saturation : {pale, grey}) {
    if (best.contrast->share() > 1.0)
      break;
    const FocusContrast paler = at(saturation);
    if (paler.contrast->share() > best.contrast->share())
      best = paler;
  }
  return best;
}

} // namespace fenestra
