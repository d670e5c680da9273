#pragma once
// Linear and affine maps of space.

#include "base/Tuple.h"

namespace fenestra::core {

using Vec3 = Vector<double, 3>;

/// 3 x 3 matrix, stored by columns.
class Mat3 {
public:
  Mat3() = default; ///< uninitialized
  constexpr Mat3(const Vec3& x, const Vec3& y, const Vec3& z) : m_columns{x, y, z} {}
  static constexpr Mat3 Identity() { return {Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ()}; }
  static constexpr Mat3 Zero() { return {Vec3::Zero(), Vec3::Zero(), Vec3::Zero()}; }
  static constexpr Mat3 Diagonal(const Vec3& d) {
    return {d[0] * Vec3::UnitX(), d[1] * Vec3::UnitY(), d[2] * Vec3::UnitZ()};
  }
  static constexpr Mat3 FromRows(const Vec3& x, const Vec3& y, const Vec3& z) {
    return Mat3(x, y, z).transpose();
  }

  constexpr double operator()(std::ptrdiff_t row, std::ptrdiff_t column) const {
    return m_columns[column][row];
  }
  constexpr double& operator()(std::ptrdiff_t row, std::ptrdiff_t column) {
    return m_columns[column][row];
  }
  constexpr const Vec3& col(std::ptrdiff_t i) const { return m_columns[i]; }
  constexpr Vec3& col(std::ptrdiff_t i) { return m_columns[i]; }
  constexpr Vec3 row(std::ptrdiff_t i) const {
    return {m_columns[0][i], m_columns[1][i], m_columns[2][i]};
  }
  constexpr Mat3 transpose() const { return {row(0), row(1), row(2)}; }

  constexpr double trace() const { return m_columns[0][0] + m_columns[1][1] + m_columns[2][2]; }
  double determinant() const;
  /// Inverse by cofactors; infinite or NaN for a singular matrix.
  Mat3 inverse() const;
  Vec3 columnNorms() const { return {col(0).norm(), col(1).norm(), col(2).norm()}; }
  Vec3 rowSums() const { return col(0) + col(1) + col(2); }
  /// Each column divided by its norm.
  Mat3 normalizedColumns() const {
    return {col(0).normalized(), col(1).normalized(), col(2).normalized()};
  }
  Mat3 cwiseAbs() const { return {col(0).cwiseAbs(), col(1).cwiseAbs(), col(2).cwiseAbs()}; }

  constexpr Mat3 operator-() const { return {-col(0), -col(1), -col(2)}; }
  constexpr Mat3& operator*=(double factor) {
    for (Vec3& column : m_columns)
      column *= factor;
    return *this;
  }
  friend constexpr bool operator==(const Mat3&, const Mat3&) = default;

private:
  Vec3 m_columns[3];
};

/// Sums follow Eigen's order, so that images stay bit-identical.
constexpr Vec3 operator*(const Mat3& m, const Vec3& v) {
  const Vec3 &a = m.col(0), &b = m.col(1), &c = m.col(2);
  return {(a[0] * v[0] + b[0] * v[1]) + c[0] * v[2], (a[1] * v[0] + b[1] * v[1]) + c[1] * v[2],
          a[2] * v[0] + (b[2] * v[1] + c[2] * v[2])};
}
constexpr Mat3 operator*(const Mat3& a, const Mat3& b) {
  return {a * b.col(0), a * b.col(1), a * b.col(2)};
}
constexpr Mat3 operator*(const Mat3& m, double factor) {
  return {m.col(0) * factor, m.col(1) * factor, m.col(2) * factor};
}
constexpr Mat3 operator*(double factor, const Mat3& m) {
  return m * factor;
}
constexpr Mat3 operator+(const Mat3& a, const Mat3& b) {
  return {a.col(0) + b.col(0), a.col(1) + b.col(1), a.col(2) + b.col(2)};
}
constexpr Mat3 operator-(const Mat3& a, const Mat3& b) {
  return {a.col(0) - b.col(0), a.col(1) - b.col(1), a.col(2) - b.col(2)};
}

/// p -> linear * p + translation.
class Affine {
public:
  Affine() = default; ///< uninitialized
  constexpr explicit Affine(const Mat3& linear, const Vec3& translation = Vec3::Zero())
      : m_linear(linear), m_translation(translation) {}
  static constexpr Affine Identity() { return Affine(Mat3::Identity()); }

  constexpr const Mat3& linear() const { return m_linear; }
  constexpr Mat3& linear() { return m_linear; }
  constexpr const Vec3& translation() const { return m_translation; }
  constexpr Vec3& translation() { return m_translation; }

  Affine inverse() const;
  /// Composes with a translation, applied before this map.
  void translate(const Vec3& by) { m_translation = m_linear * by + m_translation; }

  friend constexpr bool operator==(const Affine&, const Affine&) = default;

private:
  Mat3 m_linear;
  Vec3 m_translation;
};

constexpr Vec3 operator*(const Affine& map, const Vec3& point) {
  const Vec3 &a = map.linear().col(0), &b = map.linear().col(1), &c = map.linear().col(2),
             &d = map.translation(), &p = point;
  return {a[0] * p[0] + b[0] * p[1] + c[0] * p[2] + d[0],
          a[1] * p[0] + b[1] * p[1] + c[1] * p[2] + d[1],
          (a[2] * p[0] + b[2] * p[1]) + (c[2] * p[2] + d[2])};
}
/// Composition: b is applied first.
constexpr Affine operator*(const Affine& a, const Affine& b) {
  return Affine(a.linear() * b.linear(), a.linear() * b.translation() + a.translation());
}

/// LPS (DICOM, ITK) to RAS; its own inverse.
inline constexpr Mat3 lpsToRas = Mat3::Diagonal({-1.0, -1.0, 1.0});

constexpr Affine makeTranslation(const Vec3& by) {
  return Affine(Mat3::Identity(), by);
}
constexpr Affine makeScaling(const Vec3& factors) {
  return Affine(Mat3::Diagonal(factors));
}
/// Right-handed rotation about a unit axis through the origin; radians.
Affine makeRotation(double angle, const Vec3& axis);

} // namespace fenestra::core
