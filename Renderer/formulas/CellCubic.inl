// Along a ray, trilinear interpolation in a cell is a cubic. Finds where it first becomes >= 0.

/// c0 + c1 s + c2 s^2 + c3 s^3.
struct Cubic {
  Float c0, c1, c2, c3;
};
FORMULA Float evalCubic(STRUCT(Cubic) c, Float s) {
  return c.c0 + s * (c.c1 + s * (c.c2 + s * c.c3));
}
FORMULA Float evalSlope(STRUCT(Cubic) c, Float s) {
  return c.c1 + s * (2.0F * c.c2 + s * 3.0F * c.c3);
}

/// s if it lies in (0, 1), else 1; 1 for NaN and infinity.
FORMULA Float orEnd(Float s) {
  return select(both(s > 0.0F, s < 1.0F), s, 1.0F);
}
/// Turning points of a cubic in (0, 1), ascending; missing ones are 1.
struct TurningPoints {
  Float first, second;
};
FORMULA TurningPoints findTurningPoints(STRUCT(Cubic) cubic) {
  const Float a = 3.0F * cubic.c3;
  const Float halfB = cubic.c2;
  const Float c = cubic.c1;
  TurningPoints turns;
  turns.first = 1.0F;
  turns.second = 1.0F;
  const Float discriminant = halfB * halfB - a * c;
  if (!(discriminant > 0.0F))
    return turns;
  const Float q = -(halfB + copySign(sqrt(discriminant), halfB)); // no cancellation
  const Float one = orEnd(q / a);
  const Float other = orEnd(c / q);
  turns.first = min(one, other);
  turns.second = max(one, other);
  return turns;
}

/// Root of a monotonically increasing cubic with cubic(low) < 0 <= cubic(high). Newton iteration
/// from the secant root, with bisection where a step leaves the bracket. `rounding`: of s in [0,
/// 1].
FORMULA Float findRoot(STRUCT(Cubic) cubic, Float low, Float high, Real rounding) {
  const Float atLow = evalCubic(cubic, low);
  Float s = low + (high - low) * (atLow / (atLow - evalCubic(cubic, high)));
  for (int step = 0; step < 100 && high - low > rounding; ++step) {
    const Float value = evalCubic(cubic, s);
    if (value < 0.0F)
      low = s;
    else
      high = s;
    const Float newton = s - value / evalSlope(cubic, s);
    if (abs(newton - s) <= rounding)
      break; // must precede the bracket test: s is already an end of the bracket
    s = select(both(newton > low, newton < high), newton, 0.5F * (low + high));
  }
  return s;
}

/// Smallest s in [0, 1] with cubic(s) >= 0, or infinity.
FORMULA Float findFirstNonNegative(STRUCT(Cubic) c, Real rounding) {
  if (c.c0 >= 0.0F)
    return 0.0F;
  // The Bernstein coefficients bound the cubic. If they ascend, so does the cubic.
  const Float b1 = c.c0 + c.c1 / 3.0F;
  const Float b2 = b1 + (c.c1 + c.c2) / 3.0F;
  const Float b3 = evalCubic(c, 1.0F);
  if (max(b1, max(b2, b3)) < 0.0F)
    return infiniteReal;
  if (c.c0 <= b1 && b1 <= b2 && b2 <= b3)
    return findRoot(c, 0.0F, 1.0F, rounding);
  // The cubic is monotonic between turning points.
  const TurningPoints turns = findTurningPoints(c);
  if (evalCubic(c, turns.first) >= 0.0F)
    return findRoot(c, 0.0F, turns.first, rounding);
  if (evalCubic(c, turns.second) >= 0.0F)
    return findRoot(c, turns.first, turns.second, rounding);
  if (b3 >= 0.0F)
    return findRoot(c, turns.second, 1.0F, rounding);
  return infiniteReal;
}
