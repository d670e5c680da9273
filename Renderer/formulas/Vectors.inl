// 3D arithmetic, frames and affine maps.

FORMULA Float lerp(Float a, Float b, Float f) {
  return fma(b - a, f, a);
}
FORMULA Float clampZero(Float x) {
  return max(x, 0.0F);
}
/// sqrt(max(x, 0)): rounding may have made x negative.
FORMULA Float safeSqrt(Float x) {
  return sqrt(clampZero(x));
}
FORMULA Float square(Float x) {
  return x * x;
}

FORMULA Float dot(Float3 a, Float3 b) {
  return fma(a.x, b.x, fma(a.y, b.y, a.z * b.z));
}
FORMULA Float3 cross(Float3 a, Float3 b) {
  return Float3(fms(a.y, b.z, a.z * b.y), fms(a.z, b.x, a.x * b.z), fms(a.x, b.y, a.y * b.x));
}
FORMULA Float maxComponent(Float3 v) {
  return max(max(v.x, v.y), v.z);
}
FORMULA Float3 normalize(Float3 v) {
  return 1.0F / sqrt(dot(v, v)) * v;
}
FORMULA Float3 select(LaneMask which, Float3 yes, Float3 no) {
  return Float3(select(which, yes.x, no.x), select(which, yes.y, no.y), select(which, yes.z, no.z));
}
FORMULA Float3 zeroUnless(LaneMask which, Float3 v) {
  return Float3(zeroUnless(which, v.x), zeroUnless(which, v.y), zeroUnless(which, v.z));
}
/// -v where x < 0, else v.
FORMULA Float3 flipIfNegative(Float x, Float3 v) {
  return select(x < 0.0F, -v, v);
}

/// Applies one row of an affine map; the translation is its last number.
FORMULA Float applyRow(STRUCT(AffineRow) row, Float3 p) {
  return fma(row[0], p.x, fma(row[1], p.y, fma(row[2], p.z, row[3])));
}
FORMULA Float applyLinearRow(STRUCT(AffineRow) row, Float3 d) {
  return fma(row[0], d.x, fma(row[1], d.y, row[2] * d.z));
}
FORMULA Float3 mapPoint(STRUCT(AffineRows) map, Float3 p) {
  return Float3(applyRow(map[0], p), applyRow(map[1], p), applyRow(map[2], p));
}
FORMULA Float3 mapDirection(STRUCT(AffineRows) map, Float3 d) {
  return Float3(applyLinearRow(map[0], d), applyLinearRow(map[1], d), applyLinearRow(map[2], d));
}

/// Cosine and sine of an angle.
struct CosineSine {
  Float cosine, sine;
};

/// A right-handed orthonormal frame, as Frame in base/Vector.h.
struct Frames {
  Float3 tangent, bitangent, normal;
};
/// Frame around a unit normal (Duff et al. 2017).
FORMULA Frames makeFrames(Float3 n) {
  const Float sign = copySign(1.0F, n.z);
  const Float a = Float(-1.0F) / (sign + n.z);
  const Float b = n.x * n.y * a;
  Frames frames;
  frames.tangent = Float3(fma(sign * square(n.x), a, 1.0F), sign * b, -(sign * n.x));
  frames.bitangent = Float3(b, fma(square(n.y), a, sign), -n.y);
  frames.normal = n;
  return frames;
}
FORMULA Float3 fromFrame(STRUCT(Frames) frame, Float3 v) {
  return v.x * frame.tangent + v.y * frame.bitangent + v.z * frame.normal;
}
FORMULA Float3 toFrame(STRUCT(Frames) frame, Float3 v) {
  return Float3(dot(v, frame.tangent), dot(v, frame.bitangent), dot(v, frame.normal));
}
