// The types and functions of README.md in GLSL: one lane. Built-in functions that formulas replace, or that treat NaN in
// another way, get other names. Division, sqrt and floor are the device's.

#define FORMULA
#define CONSTANT const
#define STRUCT(T) T
#define SHIFT_LEFT(x, by) ((x) << (by))
#define SHIFT_RIGHT(x, by) ((x) >> (by))

#define Real float
#define Float float
#define Float3 vec3
#define Float4 vec4
#define Point vec3
#define Color vec3
#define Int int
#define UInt uint
#define LaneMask bool
#define AffineRow vec4
#define AffineRows mat3x4

#define infiniteReal uintBitsToFloat(0x7f800000u)
#define tinyReal uintBitsToFloat(0x00800000u)

#define noLanes() false
#define allLanes() true
#define isAny(m) (m)
#define both(a, b) ((a) && (b))
#define either(a, b) ((a) || (b))
#define without(a, b) ((a) && !(b))
#define isAllEqual(x, value) ((x) == (value))

Float select(LaneMask m, Float yes, Float no) {
  return m ? yes : no;
}
Int select(LaneMask m, Int yes, Int no) {
  return m ? yes : no;
}
Float zeroUnless(LaneMask m, Float yes) {
  return m ? yes : 0.0;
}

#define fma(a, b, c) ((a) * (b) + (c))
#define fms(a, b, c) ((a) * (b) - (c))
#define fnma(a, b, c) ((c) - (a) * (b))
#define min(a, b) lesser(a, b)
#define max(a, b) greater(a, b)
// Both return b if a or b is NaN.
Float lesser(Float a, Float b) {
  return a < b ? a : b;
}
Float greater(Float a, Float b) {
  return a > b ? a : b;
}
#define dot(a, b) dotProduct(a, b)
#define cross(a, b) crossProduct(a, b)
#define normalize(v) unitVector(v)
#define log(x) naturalLogarithm(x)

#define toFloat(x) Float(x)
#define toInt(x) Int(x)
#define bitsAsFloat(x) uintBitsToFloat(x)
Int bitsAsInt(Float x) {
  return floatBitsToInt(x);
}
Int bitsAsInt(UInt x) {
  return Int(x);
}
UInt bitsAsUInt(Float x) {
  return floatBitsToUint(x);
}
UInt bitsAsUInt(Int x) {
  return UInt(x);
}
Float copySign(Float magnitude, Float sign) {
  const UInt signBit = 0x80000000u;
  return bitsAsFloat((bitsAsUInt(magnitude) & ~signBit) | (bitsAsUInt(sign) & signBit));
}
