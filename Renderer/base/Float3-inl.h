// Three or four Floats per lane, for scalar and SIMD code: included inside their namespaces.

/// A vector, point or color per lane.
struct Float3 {
  Float x, y, z;

  Float3() = default;
  FORMULA Float3(Float a, Float b, Float c) : x(a), y(b), z(c) {}
  /// Converts any triple of scalars, the same for every lane.
  template <typename Triple>
  requires requires(const Triple& v) { Real{v[2]}; }
  FORMULA Float3(const Triple& v) : x(v[0]), y(v[1]), z(v[2]) {}
};

FORMULA Float3 operator+(const Float3& a, const Float3& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
FORMULA Float3 operator-(const Float3& a, const Float3& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
FORMULA Float3 operator*(const Float3& a, const Float3& b) {
  return {a.x * b.x, a.y * b.y, a.z * b.z};
}
FORMULA Float3 operator*(Float s, const Float3& v) {
  return {s * v.x, s * v.y, s * v.z};
}
FORMULA Float3 operator-(const Float3& v) {
  return {-v.x, -v.y, -v.z};
}

/// Values at four points of a lattice.
struct Float4 {
  Float values[4];

  FORMULA Float& operator[](std::size_t i) { return values[i]; }
  FORMULA Float operator[](std::size_t i) const { return values[i]; }
};
