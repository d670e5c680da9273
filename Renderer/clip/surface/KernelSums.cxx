#include "clip/surface/KernelSums.h"

#include "base/SimdTargets.h"

#include <algorithm>
#include <array>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "clip/surface/KernelSums.cxx"
#include <hwy/foreach_target.h>
// After foreach_target.h:
#include <hwy/contrib/math/math-inl.h>
#include <hwy/highway.h>
HWY_BEFORE_NAMESPACE();
namespace fenestra::core::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

using Doubles = hn::ScalableTag<double>;
using D = hn::Vec<Doubles>;
constexpr Doubles doubles{};

/// values[i] = function(x[i], values[i]), in SIMD vectors.
template <typename Function>
HWY_INLINE void mapVectors(std::span<const double> x, std::span<double> values,
                           Function&& function) {
  const std::size_t lanes = hn::Lanes(doubles);
  std::size_t i = 0;
  for (; i + lanes <= x.size(); i += lanes)
    hn::StoreU(function(hn::LoadU(doubles, &x[i]), hn::LoadU(doubles, &values[i])), doubles,
               &values[i]);
  if (i == x.size())
    return;
  // Not all instruction sets can load partial vectors.
  alignas(64) std::array<double, HWY_MAX_BYTES / sizeof(double)> restOfX{}, rest{};
  std::copy(x.begin() + static_cast<std::ptrdiff_t>(i), x.end(), restOfX.begin());
  std::copy_n(&values[i], x.size() - i, rest.begin());
  hn::Store(function(hn::Load(doubles, restOfX.data()), hn::Load(doubles, rest.data())), doubles,
            rest.data());
  std::copy_n(rest.begin(), x.size() - i, &values[i]);
}

void addKernelsSimd(std::span<const KernelTerm> terms, std::span<const double> u, double v,
                    std::span<double> sums) {
  // Keeps the logarithm finite at a site, where its factor is 0.
  const D tiny = hn::Set(doubles, 1e-300);
  mapVectors(u, sums, [&](D x, D sum) {
    for (const KernelTerm& term : terms) {
      const double dy = v - term.site.y();
      const D dx = hn::Sub(x, hn::Set(doubles, term.site.x()));
      const D squared = hn::MulAdd(dx, dx, hn::Set(doubles, dy * dy));
      const D phi = hn::Mul(squared, hn::Log(doubles, hn::Add(squared, tiny)));
      sum = hn::MulAdd(hn::Set(doubles, term.weight), phi, sum);
    }
    return sum;
  });
}

void evaluatePolynomialSimd(std::span<const double> coefficients, double scale,
                            std::span<const double> x, std::span<double> values) {
  mapVectors(x, values, [&](D here, D) {
    const D tau = hn::Mul(here, hn::Set(doubles, scale));
    D sum = hn::Set(doubles, coefficients.back());
    for (std::size_t k = coefficients.size() - 1; k-- > 0;)
      sum = hn::MulAdd(sum, tau, hn::Set(doubles, coefficients[k]));
    return sum;
  });
}

} // namespace
} // namespace fenestra::core::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace fenestra::core {

HWY_EXPORT(addKernelsSimd);
HWY_EXPORT(evaluatePolynomialSimd);

void addKernels(std::span<const KernelTerm> terms, std::span<const double> u, double v,
                std::span<double> sums) {
  HWY_DYNAMIC_DISPATCH(addKernelsSimd)(terms, u, v, sums);
}

void evaluatePolynomial(std::span<const double> coefficients, double scale,
                        std::span<const double> x, std::span<double> values) {
  HWY_DYNAMIC_DISPATCH(evaluatePolynomialSimd)(coefficients, scale, x, values);
}

} // namespace fenestra::core
#endif
