// Least squares in 16 windows at once, as loops over 16 lanes that the compiler vectorizes.
// Included once per instruction set, within its namespace.

#if defined(FENESTRA_LOCALFIT_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef FENESTRA_LOCALFIT_INL_H
#undef FENESTRA_LOCALFIT_INL_H
#else
#define FENESTRA_LOCALFIT_INL_H
#endif

#include "denoise/filter/WindowSums.h"

#include <algorithm>
#include <array>

HWY_BEFORE_NAMESPACE();
namespace fenestra::core::HWY_NAMESPACE {
namespace {

constexpr std::size_t lanes = 16;

struct alignas(64) Lanes {
  float v[lanes];
};

template <typename Function>
HWY_INLINE void forEachLane(Function&& function) {
  for (std::size_t l = 0; l < lanes; ++l)
    function(l);
}

/// Computes a window's coefficients from its sums, multiplied by its pixel count, which weights the
/// average over windows. Minimizes
///   sum over pixels of (c - a - b . (f - mean f))^2 + n ridge |b|^2
/// over a and b, for color c, features f and n pixels, by the normal equations, with an L D L^T
/// factorization.
class LocalFit {
public:
  explicit LocalFit(const SumLayout& layout) : m_layout(layout) {}

  /// Order of `sums` and of `out`: SumLayout.
  HWY_INLINE void solve(const Lanes* sums, Lanes* out) {
    forEachLane([&](std::size_t l) {
      m_count.v[l] = sums[SumLayout::pixelCount].v[l];
      m_inverse.v[l] = m_count.v[l] > 0.0F ? 1.0F / m_count.v[l] : 0.0F;
      m_ridge.v[l] = ridge * (1.0F + 40.0F * m_inverse.v[l]); // stronger in small windows
    });
    factor(sums);
    for (std::size_t c = 0; c < m_layout.colors; ++c)
      fit(sums, c, out);
    out[SumLayout::pixelCount] = m_count;
  }

private:
  static constexpr float ridge = 1e-4F; ///< for features of unit standard deviation over the image
  static constexpr std::size_t maxFeatures = SumLayout::maxFeatures;

  HWY_INLINE void factor(const Lanes* sums) {
    const std::size_t count = m_layout.features;
    for (std::size_t j = 0; j < count; ++j)
      for (std::size_t i = j; i < count; ++i) {
        const Lanes& product = sums[m_layout.product(j, i)];
        const Lanes &sumI = sums[m_layout.feature(i)], &sumJ = sums[m_layout.feature(j)];
        Lanes& t = m_scaled[i][j];
        forEachLane([&](std::size_t l) {
          t.v[l] = (product.v[l] - sumI.v[l] * sumJ.v[l] * m_inverse.v[l]) * m_inverse.v[l];
        });
        if (i == j)
          forEachLane([&](std::size_t l) { t.v[l] += m_ridge.v[l]; });
        for (std::size_t q = 0; q < j; ++q)
          forEachLane([&](std::size_t l) { t.v[l] -= m_scaled[i][q].v[l] * m_unit[j][q].v[l]; });
        if (i == j)
          forEachLane([&](std::size_t l) {
            m_pivot[j].v[l] = 1.0F / std::max(t.v[l], 0.01F * m_ridge.v[l]);
          });
        else
          forEachLane([&](std::size_t l) { m_unit[i][j].v[l] = t.v[l] * m_pivot[j].v[l]; });
      }
  }

  HWY_INLINE void fit(const Lanes* sums, std::size_t color, Lanes* out) {
    const std::size_t count = m_layout.features;
    const Lanes& sum = sums[m_layout.color(color)];
    std::array<Lanes, maxFeatures> b;
    for (std::size_t i = 0; i < count; ++i) {
      const Lanes& product = sums[m_layout.featureColor(i, color)];
      const Lanes& featureSum = sums[m_layout.feature(i)];
      forEachLane([&](std::size_t l) {
        b[i].v[l] = (product.v[l] - featureSum.v[l] * sum.v[l] * m_inverse.v[l]) * m_inverse.v[l];
      });
      for (std::size_t q = 0; q < i; ++q)
        forEachLane([&](std::size_t l) { b[i].v[l] -= m_unit[i][q].v[l] * b[q].v[l]; });
    }
    Lanes a = sum;
    for (std::size_t i = count; i-- > 0;) {
      forEachLane([&](std::size_t l) { b[i].v[l] *= m_pivot[i].v[l]; });
      for (std::size_t q = i + 1; q < count; ++q)
        forEachLane([&](std::size_t l) { b[i].v[l] -= m_unit[q][i].v[l] * b[q].v[l]; });
      const Lanes& featureSum = sums[m_layout.feature(i)];
      forEachLane([&](std::size_t l) { a.v[l] -= b[i].v[l] * featureSum.v[l]; });
      forEachLane(
          [&](std::size_t l) { out[m_layout.slope(color, i)].v[l] = b[i].v[l] * m_count.v[l]; });
    }
    out[m_layout.intercept(color)] = a;
  }

  const SumLayout& m_layout;
  Lanes m_count, m_inverse, m_ridge;        ///< pixels; 1 / pixels
  Lanes m_scaled[maxFeatures][maxFeatures]; ///< L D, lower triangle
  Lanes m_unit[maxFeatures][maxFeatures];   ///< L
  Lanes m_pivot[maxFeatures];               ///< 1 / D
};

} // namespace
} // namespace fenestra::core::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
