#pragma once
// Approximate comparison of vectors, matrices and affine maps, by Eigen's definition of isApprox.

#include "base/Vector.h"

namespace fenestra::core {

template <template <typename, int> class Kind, typename T, int N>
bool allFinite(const Tuple<Kind, T, N>& v) {
  return std::all_of(v.begin(), v.end(), [](T x) { return std::isfinite(x); });
}
inline bool allFinite(const Mat3& m) {
  return allFinite(m.col(0)) && allFinite(m.col(1)) && allFinite(m.col(2));
}
inline bool allFinite(const Affine& map) {
  return allFinite(map.linear()) && allFinite(map.translation());
}

/// Frobenius norm; for an affine map, of its 3 x 4 matrix.
inline double frobeniusNorm(const Mat3& m) {
  return std::hypot(m.col(0).norm(), m.col(1).norm(), m.col(2).norm());
}
inline double frobeniusNorm(const Affine& map) {
  return std::hypot(frobeniusNorm(map.linear()), map.translation().norm());
}

/// True if |a - b| <= relative * min(|a|, |b|).
template <template <typename, int> class Kind, typename T, int N>
bool isApprox(const Tuple<Kind, T, N>& a, const Kind<T, N>& b, T relative = T(1e-12)) {
  T difference = 0, norm = 0, other = 0; // squared norms
  for (int i = 0; i < N; ++i) {
    difference += (a[i] - b[i]) * (a[i] - b[i]);
    norm += a[i] * a[i];
    other += b[i] * b[i];
  }
  return difference <= relative * relative * std::min(norm, other);
}
inline bool isApprox(const Mat3& a, const Mat3& b, double relative = 1e-12) {
  return frobeniusNorm(a - b) <= relative * std::min(frobeniusNorm(a), frobeniusNorm(b));
}
inline bool isApprox(const Affine& a, const Affine& b, double relative = 1e-12) {
  const Affine difference(a.linear() - b.linear(), a.translation() - b.translation());
  return frobeniusNorm(difference) <= relative * std::min(frobeniusNorm(a), frobeniusNorm(b));
}

} // namespace fenestra::core
