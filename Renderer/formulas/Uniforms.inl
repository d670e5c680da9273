// Random bits to numbers and angles, in float, without functions of the device.

/// (h + 1/2) / 2^32 for h < 2^31: as precise near 0 as 32 bits allow.
FORMULA Float toFraction(UInt h) {
  return fma(toFloat(bitsAsInt(h)), 2.3283064365386963e-10F, 1.1641532182693481e-10F);
}

/// Half of the unit interval that random bits select, and the position in it.
struct SplitUniform {
  LaneMask upper;
  Float low; ///< in (0, 1/2)
};
FORMULA SplitUniform splitUniform(UInt h) {
  SplitUniform u;
  u.upper = bitsAsInt(h) < 0;
  u.low = toFraction(h & 0x7fffffffU);
  return u;
}

/// Uniform in (0, 1].
FORMULA Float toUniform(UInt h) {
  const SplitUniform u = splitUniform(h);
  return u.low + zeroUnless(u.upper, 0.5F);
}
/// Uniform in [0, 1), from the 24 leading bits.
FORMULA Float toUniformBelow1(UInt h) {
  return toFloat(bitsAsInt(SHIFT_RIGHT(h, 8))) * 5.9604644775390625e-8F;
}

/// Logarithm of a positive normal number, accurate to a float's last digit (polynomial of Cephes'
/// logf).
FORMULA Float log(Float x) {
  const Int raw = bitsAsInt(x);
  // 0x3f3504f3 is sqrt(1/2) as bits: mantissas lie in [sqrt(1/2), sqrt(2)).
  const Int power = SHIFT_RIGHT(raw - 0x3f3504f3, 23);
  const Float f = bitsAsFloat(raw - SHIFT_LEFT(power, 23)) - 1.0F;
  const Float e = toFloat(power);
  Float p = fma(7.0376836292E-2F, f, -1.1514610310E-1F);
  p = fma(p, f, 1.1676998740E-1F);
  p = fma(p, f, -1.2420140846E-1F);
  p = fma(p, f, 1.4249322787E-1F);
  p = fma(p, f, -1.6668057665E-1F);
  p = fma(p, f, 2.0000714765E-1F);
  p = fma(p, f, -2.4999993993E-1F);
  p = fma(p, f, 3.3333331174E-1F);
  const Float f2 = f * f; // below: log 2 = 0.693359375 - 2.12194440E-4
  const Float low = fnma(0.5F, f2, fma(e, -2.12194440E-4F, p * f * f2));
  return fma(e, 0.693359375F, f + low);
}

/// Exponential variate of mean 1, precise near 0 and in the tail: each half of the unit interval is
/// measured from its own end.
FORMULA Float toExponential(UInt h) {
  const SplitUniform u = splitUniform(h);
  // -log(1 - u) where the exponential is small, -log(u) where it is large.
  const Float x = select(u.upper, 1.0F - u.low, u.low);
  const Float lost = zeroUnless(u.upper, 1.0F - x - u.low); // rounding error of 1 - u
  return -(log(x) + lost);
}

/// Cosine and sine of an angle in turns, 0 <= turns <= 1, to 1e-7: Taylor series about the nearest
/// multiple of a quarter turn.
FORMULA CosineSine cosSinTurns(Float turns) {
  const Float quarters = turns * 4.0F;
  const Float nearest = floor(quarters + 0.5F);
  const Float x = (quarters - nearest) * 1.57079632679F;
  const Float x2 = x * x;
  Float cubic = fma(2.75573192e-6F, x2, -1.98412698e-4F);
  cubic = fma(cubic, x2, 8.33333333e-3F);
  cubic = fma(cubic, x2, -1.66666667e-1F);
  const Float sine = fma(x * x2, cubic, x);
  Float cosine = fma(-2.75573192e-7F, x2, 2.48015873e-5F);
  cosine = fma(cosine, x2, -1.38888889e-3F);
  cosine = fma(cosine, x2, 4.16666667e-2F);
  cosine = fma(cosine, x2, -0.5F);
  cosine = fma(cosine, x2, 1.0F);
  const UInt quadrant = bitsAsUInt(toInt(nearest));
  const UInt odd = quadrant & 1U;
  const LaneMask swapped = odd == 1U;
  const UInt sineSign = SHIFT_LEFT(quadrant & 2U, 30);
  const UInt cosineSign = sineSign ^ SHIFT_LEFT(odd, 31);
  CosineSine result;
  result.cosine = bitsAsFloat(bitsAsUInt(select(swapped, sine, cosine)) ^ cosineSign);
  result.sine = bitsAsFloat(bitsAsUInt(select(swapped, cosine, sine)) ^ sineSign);
  return result;
}

/// Angle of the point (x, y) in turns from the x axis, in [-1/2, 1/2], to 1e-7; 0 at the origin.
FORMULA Float angleInTurns(Float x, Float y) {
  const Float minor = min(abs(x), abs(y));
  const Float major = max(abs(x), abs(y));
  const Float q = minor / max(major, tinyReal);
  // Minimax polynomial of atan(q) / (2 pi q), with a relative error of 1.5e-8.
  const Float q2 = q * q;
  Float p = fma(4.535739899e-4F, q2, -2.557401608e-3F);
  p = fma(p, q2, 6.794566131e-3F);
  p = fma(p, q2, -1.194345555e-2F);
  p = fma(p, q2, 1.693557243e-2F);
  p = fma(p, q2, -2.260580226e-2F);
  p = fma(p, q2, 3.181924202e-2F);
  p = fma(p, q2, -5.305123391e-2F);
  p = fma(p, q2, 1.591549407e-1F);
  const Float octant = q * p;
  const Float quadrant = select(abs(y) > abs(x), 0.25F - octant, octant);
  return copySign(select(x < 0.0F, 0.5F - quadrant, quadrant), y);
}
