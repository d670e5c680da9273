// Interpolation between the points of a lattice, and Sobel's gradient there. Positions are indices.

/// A point along one axis, clamped to the outer lattice points.
struct AxisPosition {
  Float lower;    ///< index of the lattice point below, an integer
  Float fraction; ///< distance from it, 0 to 1
};
/// `last`: index of the last lattice point; lastCell: maximum of `lower`. NaN counts as 0.
FORMULA AxisPosition locateOnAxis(Real last, Real lastCell, Float x) {
  const Float inside = max(min(x, last), 0.0F);
  AxisPosition position;
  position.lower = min(floor(inside), lastCell);
  position.fraction = inside - position.lower;
  return position;
}

/// Bilinear between (0, 0), (1, 0), (0, 1) and (1, 1).
FORMULA Float interpolate(Float v00, Float v10, Float v01, Float v11, Float x, Float y) {
  return lerp(lerp(v00, v10, x), lerp(v01, v11, x), y);
}

/// Weight of a segment's color where segments meet, before division by the sum of all. `fraction`:
/// its label weight, which rises within about two voxels. Light enters an organ less deep than
/// that: a mean by label weight would show its neighbors' colors on all of its surface. The power
/// of 16 lets colors change within a tenth of that width.
FORMULA Float colorWeight(Float fraction) {
  return square(square(square(square(fraction))));
}

/// Sobel's kernel (Field::sobelGradient) along one axis, interpolated: weights of four lattice
/// points from `first` on, all inside the lattice, of which the last one repeats if the axis has
/// fewer.
struct SobelAxis {
  Float first;     ///< an integer
  Float weight[4]; ///< of the points; their sum is 1
  Float rise[3];   ///< of the differences from each point to the next
};
FORMULA SobelAxis makeSobelAxis(Real last, Real lastCell, Float x) {
  const AxisPosition at = locateOnAxis(last, lastCell, x);
  const Float before = at.lower - 1.0F;
  const Float f = at.fraction;
  SobelAxis axis;
  axis.first = max(min(before, lastCell - 2.0F), 0.0F);
  // At the border the four points begin one point later or earlier than the kernel.
  const LaneMask isLater = before < axis.first;
  const LaneMask isEarlier = axis.first < before;
  axis.rise[0] = select(isLater, 1.0F, select(isEarlier, 0.0F, 1.0F - f));
  axis.rise[1] = select(isLater, f, select(isEarlier, 1.0F - f, 1.0F));
  axis.rise[2] = select(isEarlier, 1.0F, select(isLater, 0.0F, f));
  const Float repeatFirst = zeroUnless(isLater, 2.0F * (1.0F - f));
  const Float repeatLast = zeroUnless(isEarlier, 2.0F * f);
  axis.weight[0] = 0.25F * (axis.rise[0] + repeatFirst);
  axis.weight[1] = 0.25F * (axis.rise[0] + axis.rise[1]);
  axis.weight[2] = 0.25F * (axis.rise[1] + axis.rise[2]);
  axis.weight[3] = 0.25F * (axis.rise[2] + repeatLast);
  return axis;
}
/// Mean of the values at the four points.
FORMULA Float evalMean(STRUCT(SobelAxis) a, Float4 v) {
  return fma(a.weight[0], v[0], fma(a.weight[1], v[1], fma(a.weight[2], v[2], a.weight[3] * v[3])));
}
/// Twice the derivative per lattice point. Exactly 0 if all values are equal.
FORMULA Float evalRise(STRUCT(SobelAxis) a, Float4 v) {
  return fma(a.rise[0], v[1] - v[0], fma(a.rise[1], v[2] - v[1], a.rise[2] * (v[3] - v[2])));
}
