// Directions of an environment map (EnvironmentMap: rows from north to south, in the direction d of
// RAS: u = 1/2 + atan2(d_R, d_A) / (2 pi), v = acos(d_S) / pi).

/// A bin of an alias table, and a position inside it, uniform in (0, 1].
struct Bin {
  Int index;
  Float fraction;
};
/// Bin of a slot of base/AliasTables.h. `own`: the slot's index; threshold, alias: its values;
/// rest: the random word's remaining bits, a number below `range`.
FORMULA Bin chooseBin(Int own, Float threshold, Float alias, Float rest, Real range) {
  const LaneMask below = rest < threshold;
  const Float inside = select(below, rest, rest - threshold) + 0.5F;
  const Float size = select(below, threshold, range - threshold);
  Bin bin;
  bin.index = select(below, own, toInt(alias));
  bin.fraction = inside / size;
  return bin;
}

/// Direction in a texel: uniform in solid angle if uniform in cos(theta) and in phi. `turns`: phi,
/// 0 to 1; oneMinusCos: 1 - cos(theta) from the nearer pole, which is the south where `isSouth`.
FORMULA Float3 directionInTexel(Float turns, Float oneMinusCos, LaneMask isSouth) {
  const Float sine = safeSqrt(oneMinusCos * (2.0F - oneMinusCos));
  const CosineSine phi = cosSinTurns(turns);
  const Float z = 1.0F - oneMinusCos;
  return Float3(-sine * phi.sine, -sine * phi.cosine, select(isSouth, -z, z));
}

/// Place of a direction among `width` columns, and `height` rows.
FORMULA Float columnOfDirection(Float3 d, Real width) {
  return (0.5F + angleInTurns(d.y, d.x)) * width;
}
FORMULA Float rowOfDirection(Float3 d, Real height) {
  return angleInTurns(d.z, sqrt(square(d.x) + square(d.y))) * (2.0F * height);
}
/// Texel along one axis of `count`. NaN gives a valid index, too.
FORMULA Int texelOnAxis(Float place, Real count) {
  return toInt(clampZero(min(place, count - 1.0F)));
}
