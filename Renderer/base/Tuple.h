#pragma once
// Vector (point or direction) and Array (unrelated numbers, such as a color): 1 to 4 numbers of one
// type. Both add and scale; * and < of two arrays are elementwise. Members have Eigen's names, but
// this header does not include Eigen, whose templates took half of the compile time. Sums and dot
// products run left to right, so that images stay bit-identical.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <ostream>

namespace fenestra::core {

template <typename T, int N>
class Vector;
template <typename T, int N>
class Array;

/// Base of Vector and Array. T: type of a component; N: number of components, 1 to 4.
template <template <typename, int> class Kind, typename T, int N>
class Tuple {
public:
  using Scalar = T;
  using Self = Kind<T, N>;

  Tuple() = default; ///< uninitialized, like an int
  static constexpr Self Constant(T value) {
    Self result;
    for (T& part : result.m_parts)
      part = value;
    return result;
  }
  static constexpr Self Zero() { return Constant(T(0)); }
  static constexpr Self Ones() { return Constant(T(1)); }

  static constexpr int size() { return N; }
  constexpr const T& operator[](std::ptrdiff_t i) const { return m_parts[i]; }
  constexpr T& operator[](std::ptrdiff_t i) { return m_parts[i]; }
  constexpr const T& x() const { return m_parts[0]; }
  constexpr T& x() { return m_parts[0]; }
  constexpr const T& y() const { return m_parts[1]; }
  constexpr T& y() { return m_parts[1]; }
  constexpr const T& z() const requires(N > 2) { return m_parts[2]; }
  constexpr T& z() requires(N > 2) { return m_parts[2]; }
  constexpr const T* data() const { return m_parts; }
  constexpr T* data() { return m_parts; }
  constexpr const T* begin() const { return m_parts; }
  constexpr const T* end() const { return m_parts + N; }

  constexpr void setZero() { self() = Zero(); }

  /// Applies f to each component.
  template <typename F>
  constexpr auto unaryExpr(F&& f) const {
    Kind<decltype(f(m_parts[0])), N> result;
    for (int i = 0; i < N; ++i)
      result[i] = f(m_parts[i]);
    return result;
  }
  template <typename U>
  constexpr Kind<U, N> cast() const {
    return unaryExpr([](T part) { return static_cast<U>(part); });
  }
  template <int M>
  constexpr Kind<T, M> head() const {
    static_assert(M <= N);
    Kind<T, M> result;
    for (int i = 0; i < M; ++i)
      result[i] = m_parts[i];
    return result;
  }

  constexpr T sum() const {
    T total = m_parts[0];
    for (int i = 1; i < N; ++i)
      total += m_parts[i];
    return total;
  }
  constexpr T prod() const {
    T product = m_parts[0];
    for (int i = 1; i < N; ++i)
      product *= m_parts[i];
    return product;
  }
  constexpr T mean() const { return sum() / T(N); }
  constexpr T maxCoeff() const { return *std::max_element(begin(), end()); }
  constexpr T minCoeff() const { return *std::min_element(begin(), end()); }
  /// True if |x| <= tolerance for every component x.
  bool isZero(T tolerance = T(1e-12)) const {
    return std::all_of(begin(), end(), [tolerance](T part) { return std::abs(part) <= tolerance; });
  }

  constexpr Self cwiseMax(const Self& o) const {
    return combine(o, [](T a, T b) { return std::max(a, b); });
  }
  constexpr Self cwiseMin(const Self& o) const {
    return combine(o, [](T a, T b) { return std::min(a, b); });
  }
  constexpr Self cwiseMax(T o) const { return cwiseMax(Constant(o)); }
  constexpr Self cwiseMin(T o) const { return cwiseMin(Constant(o)); }
  constexpr Self cwiseAbs() const {
    return unaryExpr([](T part) { return std::abs(part); });
  }

  constexpr Self operator-() const {
    return unaryExpr([](T part) { return T(-part); });
  }
  constexpr Self& operator+=(const Self& o) & { return self() = self() + o; }
  constexpr Self& operator-=(const Self& o) & { return self() = self() - o; }
  constexpr Self& operator*=(T factor) & { return self() = self() * factor; }
  constexpr Self& operator/=(T divisor) & { return self() = self() / divisor; }

  friend constexpr Self operator+(const Self& a, const Self& b) {
    return a.combine(b, [](T p, T q) { return T(p + q); });
  }
  friend constexpr Self operator-(const Self& a, const Self& b) {
    return a.combine(b, [](T p, T q) { return T(p - q); });
  }
  friend constexpr Self operator*(const Self& a, T factor) {
    return a.unaryExpr([factor](T part) { return T(part * factor); });
  }
  friend constexpr Self operator*(T factor, const Self& a) {
    return a.unaryExpr([factor](T part) { return T(factor * part); });
  }
  friend constexpr Self operator/(const Self& a, T divisor) {
    return a.unaryExpr([divisor](T part) { return T(part / divisor); });
  }

protected:
  template <typename... Parts>
  constexpr void assign(Parts... parts) {
    int i = 0;
    ((m_parts[i++] = parts), ...);
  }

  template <typename F>
  constexpr auto combine(const Self& o, F&& f) const {
    Kind<decltype(f(m_parts[0], o[0])), N> result;
    for (int i = 0; i < N; ++i)
      result[i] = f(m_parts[i], o[i]);
    return result;
  }

  T m_parts[N];

private:
  constexpr Self& self() { return static_cast<Self&>(*this); }
};

/// Prints "x y z".
template <template <typename, int> class Kind, typename T, int N>
std::ostream& operator<<(std::ostream& out, const Tuple<Kind, T, N>& tuple) {
  for (int i = 0; i < N; ++i)
    out << (i > 0 ? " " : "") << tuple[i];
  return out;
}

template <typename T, int N>
class Array : public Tuple<Array, T, N> {
public:
  Array() = default;
  Array(const Array&) = default;
  Array& operator=(const Array&) & = default; // not for temporaries
  /// Sets every component. Implicit, so that `array < 1.0` compares each component with 1.
  constexpr Array(T each) { *this = Array::Constant(each); }
  constexpr Array(T x, T y) requires(N == 2) { this->assign(x, y); }
  constexpr Array(T x, T y, T z) requires(N == 3) { this->assign(x, y, z); }

  constexpr Vector<T, N> matrix() const { return *this; }
  constexpr T value() const requires(N == 1) { return (*this)[0]; }

  constexpr Array max(const Array& o) const { return this->cwiseMax(o); }
  constexpr Array min(const Array& o) const { return this->cwiseMin(o); }
  constexpr Array abs() const { return this->cwiseAbs(); }
  Array floor() const {
    return this->unaryExpr([](T part) { return std::floor(part); });
  }
  Array ceil() const {
    return this->unaryExpr([](T part) { return std::ceil(part); });
  }
  Array round() const {
    return this->unaryExpr([](T part) { return std::round(part); });
  }
  constexpr Array square() const { return *this * *this; }
  Array sqrt() const {
    return this->unaryExpr([](T part) { return std::sqrt(part); });
  }
  Array log() const {
    return this->unaryExpr([](T part) { return std::log(part); });
  }
  /// all() and any() are meant for T = bool.
  constexpr bool all() const {
    return std::all_of(this->begin(), this->end(), [](T part) { return bool(part); });
  }
  constexpr bool any() const {
    return std::any_of(this->begin(), this->end(), [](T part) { return bool(part); });
  }

  constexpr Array& operator*=(const Array& o) & { return *this = *this * o; }
  constexpr Array& operator/=(const Array& o) & { return *this = *this / o; }

  friend constexpr Array operator*(const Array& a, const Array& b) {
    return a.combine(b, [](T p, T q) { return T(p * q); });
  }
  friend constexpr Array operator/(const Array& a, const Array& b) {
    return a.combine(b, [](T p, T q) { return T(p / q); });
  }

  using Bools = Array<bool, N>;
  friend constexpr Bools operator<(const Array& a, const Array& b) {
    return a.combine(b, [](T p, T q) { return p < q; });
  }
  friend constexpr Bools operator<=(const Array& a, const Array& b) {
    return a.combine(b, [](T p, T q) { return p <= q; });
  }
  friend constexpr Bools operator>(const Array& a, const Array& b) { return b < a; }
  friend constexpr Bools operator>=(const Array& a, const Array& b) { return b <= a; }
  friend constexpr bool operator==(const Array& a, const Array& b) {
    return a.combine(b, [](T p, T q) { return p == q; }).all();
  }
  friend constexpr Bools operator&&(const Array& a, const Array& b) {
    return a.combine(b, [](T p, T q) { return p && q; });
  }
};

template <typename T, int N>
class Vector : public Tuple<Vector, T, N> {
public:
  Vector() = default;
  Vector(const Vector&) = default;
  Vector& operator=(const Vector&) & = default; // not for temporaries
  constexpr Vector(T x, T y) requires(N == 2) { this->assign(x, y); }
  constexpr Vector(T x, T y, T z) requires(N == 3) { this->assign(x, y, z); }
  constexpr Vector(T x, T y, T z, T w) requires(N == 4) { this->assign(x, y, z, w); }
  /// Implicit, since arrays are often assigned to vectors.
  constexpr Vector(const Array<T, N>& parts) {
    for (int i = 0; i < N; ++i)
      (*this)[i] = parts[i];
  }

  static constexpr Vector Unit(int axis) {
    Vector result = Vector::Zero();
    result[axis] = T(1);
    return result;
  }
  static constexpr Vector UnitX() { return Unit(0); }
  static constexpr Vector UnitY() { return Unit(1); }
  static constexpr Vector UnitZ() { return Unit(2); }

  constexpr Array<T, N> array() const {
    Array<T, N> result;
    for (int i = 0; i < N; ++i)
      result[i] = (*this)[i];
    return result;
  }

  constexpr T dot(const Vector& o) const { return cwiseProduct(o).sum(); }
  constexpr T squaredNorm() const { return dot(*this); }
  T norm() const { return std::sqrt(squaredNorm()); }
  /// Unit vector; 0 for the vector 0.
  Vector normalized() const {
    const T square = squaredNorm();
    return square > T(0) ? *this / std::sqrt(square) : *this;
  }
  /// normalized() for lengths whose squares overflow or underflow.
  Vector stableNormalized() const {
    const T largest = this->cwiseAbs().maxCoeff();
    const T square = (*this / largest).squaredNorm();
    return square > T(0) ? *this / (std::sqrt(square) * largest) : *this;
  }
  constexpr Vector cross(const Vector& o) const requires(N == 3) {
    const Vector& a = *this;
    return {a[1] * o[2] - a[2] * o[1], a[2] * o[0] - a[0] * o[2], a[0] * o[1] - a[1] * o[0]};
  }

  constexpr Vector cwiseProduct(const Vector& o) const {
    return this->combine(o, [](T p, T q) { return T(p * q); });
  }
  constexpr Vector cwiseQuotient(const Vector& o) const {
    return this->combine(o, [](T p, T q) { return T(p / q); });
  }
  constexpr Vector cwiseInverse() const {
    return this->unaryExpr([](T part) { return T(1) / part; });
  }

  friend constexpr bool operator==(const Vector& a, const Vector& b) {
    return std::equal(a.begin(), a.end(), b.begin());
  }
};

} // namespace fenestra::core
