#include "base/Affine.h"

namespace fenestra::core {

double Mat3::determinant() const {
  const Mat3& m = *this;
  const auto cofactor = [&m](int a, int b, int c) {
    return m(0, a) * (m(1, b) * m(2, c) - m(1, c) * m(2, b));
  };
  return cofactor(0, 1, 2) - cofactor(1, 0, 2) + cofactor(2, 0, 1);
}

Mat3 Mat3::inverse() const {
  const Mat3& m = *this;
  const auto cofactor = [&m](int i, int j) {
    const int i1 = (i + 1) % 3, i2 = (i + 2) % 3, j1 = (j + 1) % 3, j2 = (j + 2) % 3;
    return m(i1, j1) * m(i2, j2) - m(i1, j2) * m(i2, j1);
  };
  const Vec3 first(cofactor(0, 0), cofactor(1, 0), cofactor(2, 0));
  const double perDeterminant = 1.0 / first.dot(m.col(0));
  const auto row = [&](int j) { return Vec3(cofactor(0, j), cofactor(1, j), cofactor(2, j)); };
  return FromRows(row(0) * perDeterminant, row(1) * perDeterminant, row(2) * perDeterminant);
}

Affine Affine::inverse() const {
  const Mat3 linear = m_linear.inverse();
  return Affine(linear, -(linear * m_translation));
}

/// Rodrigues' formula.
Affine makeRotation(double angle, const Vec3& axis) {
  const Vec3 s = std::sin(angle) * axis, c = (1.0 - std::cos(angle)) * axis;
  const double xy = c.x() * axis.y(), xz = c.x() * axis.z(), yz = c.y() * axis.z();
  const Vec3 diagonal = c.cwiseProduct(axis) + Vec3::Constant(std::cos(angle));
  return Affine(Mat3::FromRows({diagonal.x(), xy - s.z(), xz + s.y()},
                               {xy + s.z(), diagonal.y(), yz - s.x()},
                               {xz - s.y(), yz + s.x(), diagonal.z()}));
}

} // namespace fenestra::core
