// 3D arithmetic for scalar and SIMD code, included inside their namespaces (base/ScalarMath.h).

FENESTRA_INLINE Float lerp(Float a, Float b, Float f) {
  return fma(b - a, f, a);
}
FENESTRA_INLINE Float clampZero(Float x) {
  return max(x, 0.0F);
}
/// sqrt(max(x, 0)): rounding may have made x negative.
FENESTRA_INLINE Float safeSqrt(Float x) {
  return sqrt(clampZero(x));
}
FENESTRA_INLINE Float square(Float x) {
  return x * x;
}

/// A vector, point or color per lane.
struct Float3 {
  Float x, y, z;

  Float3() = default;
  FENESTRA_INLINE Float3(Float a, Float b, Float c) : x(a), y(b), z(c) {}
  /// Converts any triple of scalars, the same for every lane.
  template <typename Triple>
  requires requires(const Triple& v) { Real{v[2]}; }
  FENESTRA_INLINE Float3(const Triple& v) : x(v[0]), y(v[1]), z(v[2]) {}
};

FENESTRA_INLINE Float3 operator+(const Float3& a, const Float3& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
FENESTRA_INLINE Float3 operator-(const Float3& a, const Float3& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
FENESTRA_INLINE Float3 operator*(const Float3& a, const Float3& b) {
  return {a.x * b.x, a.y * b.y, a.z * b.z};
}
FENESTRA_INLINE Float3 operator*(Float s, const Float3& v) {
  return {s * v.x, s * v.y, s * v.z};
}
FENESTRA_INLINE Float3 operator-(const Float3& v) {
  return {-v.x, -v.y, -v.z};
}
FENESTRA_INLINE Float dot(const Float3& a, const Float3& b) {
  return fma(a.x, b.x, fma(a.y, b.y, a.z * b.z));
}
FENESTRA_INLINE Float3 cross(const Float3& a, const Float3& b) {
  return {fms(a.y, b.z, a.z * b.y), fms(a.z, b.x, a.x * b.z), fms(a.x, b.y, a.y * b.x)};
}
FENESTRA_INLINE Float maxComponent(const Float3& v) {
  return max(max(v.x, v.y), v.z);
}
FENESTRA_INLINE Float3 normalize(const Float3& v) {
  return 1.0F / sqrt(dot(v, v)) * v;
}
FENESTRA_INLINE Float3 select(LaneMask which, const Float3& yes, const Float3& no) {
  return {select(which, yes.x, no.x), select(which, yes.y, no.y), select(which, yes.z, no.z)};
}
FENESTRA_INLINE Float3 zeroUnless(LaneMask which, const Float3& v) {
  return {zeroUnless(which, v.x), zeroUnless(which, v.y), zeroUnless(which, v.z)};
}

/// -v where x < 0, else v.
FENESTRA_INLINE Float3 flipIfNegative(Float x, const Float3& v) {
  return select(x < 0.0F, -v, v);
}

/// Cosine and sine of an angle.
struct CosineSine {
  Float cosine, sine;
};

/// A right-handed orthonormal frame around a unit normal, as Frame in base/Vector.h.
struct Frames {
  Float3 tangent, bitangent, normal;

  explicit FENESTRA_INLINE Frames(const Float3& n) : normal(n) {
    const Float sign = copySign(1.0F, n.z);
    const Float a = Float(-1.0F) / (sign + n.z);
    const Float b = n.x * n.y * a;
    tangent = {fma(sign * square(n.x), a, 1.0F), sign * b, -(sign * n.x)};
    bitangent = {b, fma(square(n.y), a, sign), -n.y};
  }

  FENESTRA_INLINE Float3 toWorld(const Float3& v) const {
    return v.x * tangent + v.y * bitangent + v.z * normal;
  }
  FENESTRA_INLINE Float3 toLocal(const Float3& v) const {
    return {dot(v, tangent), dot(v, bitangent), dot(v, normal)};
  }
};
