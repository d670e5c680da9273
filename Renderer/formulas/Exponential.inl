// The exponential function, in float, without functions of the device.

/// e^x - 1 for x <= 80, with a relative error of 2e-7; NaN for NaN. Cody and Waite's reduction to
/// |r| <= log(2) / 2 and Taylor series.
FORMULA Float expm1(Float x) {
  if (!(x >= -80.0F))
    return select(x < -80.0F, -1.0F, x);
  const Float power = floor(fma(x, 1.44269504F, 0.5F));
  const Float r = fma(power, 2.12194440e-4F, fnma(power, 0.693359375F, x));
  Float p = fma(1.98412698e-4F, r, 1.38888889e-3F);
  p = fma(p, r, 8.33333333e-3F);
  p = fma(p, r, 4.16666667e-2F);
  p = fma(p, r, 1.66666667e-1F);
  p = fma(p, r, 0.5F);
  const Float scale = bitsAsFloat(SHIFT_LEFT(toInt(power) + 127, 23));
  return fma(scale, fma(p * r, r, r), scale - 1.0F);
}
