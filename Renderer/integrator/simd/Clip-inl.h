// Clip weight and the gradient of a soft cut at points in index space (SIMD clip/field/Clip.h).

using ClipTable = single::ClipTable;
using DepthTable = single::DepthTable;
#include "formulas/Clip.inl"

/// A surface between four samples of the depth buffer.
struct Surface {
  Int sample;           ///< index of the top-left sample
  Float depth;          ///< relative to the target, mm
  Float slopeX, slopeY; ///< mm per mm
};
HWY_INLINE Surface interpolateSurface(const SimdMedium& medium, const ViewPoints& view) {
  const DepthTable &x = medium.clip.depthX, &y = medium.clip.depthY;
  const Float column = depthIndex(x, view.x);
  const Float row = depthIndex(y, view.y);
  const Int columns = medium.depthColumns;
  const Int c0 = toInt(column);
  const Int r0 = toInt(row);
  const Int c1 = min(c0 + 1, toInt(x.last));
  const Int r1 = min(r0 + 1, toInt(y.last));
  const Float fc = column - toFloat(c0);
  const Float fr = row - toFloat(r0);
  const auto at = [&](Int c, Int r) { return gather(medium.depths, r * columns + c); };
  const Float upLeft = at(c0, r0), upRight = at(c1, r0);
  const Float downLeft = at(c0, r1), downRight = at(c1, r1);
  return {r0 * columns + c0, interpolate(upLeft, upRight, downLeft, downRight, fc, fr),
          axisSlope(x, column, lerp(upRight - upLeft, downRight - downLeft, fr)),
          axisSlope(y, row, lerp(downLeft - upLeft, downRight - upRight, fc))};
}

/// Exact surface depth for the lanes of `isQueried`; `surface` for the others.
inline Float querySilhouettes(const SilhouetteCells& silhouettes, LaneMask isQueried, Int cell,
                              const ViewPoints& at, double softness, Float surface) {
  static_assert(laneCount <= SilhouetteCells::maxQueries);
  const LaneArray<std::int32_t> numbers(cell);
  const LaneArray<float> xs(at.x), ys(at.y), depths(at.depth);
  LaneArray<float> surfaces(surface);
  std::array<SilhouetteCells::Query, laneCount> queries;
  auto* query = queries.data();
  forEachLane(isQueried, [&](std::size_t lane) {
    *query++ = {numbers[lane], Vec2(xs[lane], ys[lane]), surfaces[lane], depths[lane] - softness};
  });
  silhouettes.evaluate({queries.data(), query});
  query = queries.data();
  forEachLane(isQueried,
              [&](std::size_t lane) { surfaces[lane] = static_cast<float>(query++->depth); });
  return load(surfaces.data());
}

/// ClipDepth::surfaceDepth: exact in silhouette cells for the lanes of `which`, else interpolated.
HWY_INLINE Float refineAtSilhouette(const SimdMedium& medium, LaneMask which, const Surface& linear,
                                    const ViewPoints& at) {
  const Float surface = linear.depth;
  const Int cell = gather(medium.silhouette->indices().data(), linear.sample);
  const LaneMask isSilhouette = cell > -1;
  if (!isSilhouette.any())
    return surface;
  const Int first = shiftLeft<1>(max(cell, 0));
  const float* const bounds = &medium.silhouette->depthBounds().data()->min;
  const Float nearest = min(surface, gather(bounds, first));
  const Float farthest = max(surface, gather(bounds + 1, first)); // minima and maxima alternate
  const LaneMask isNear = (at.depth >= nearest) & (at.depth <= farthest + medium.clip.softness);
  const LaneMask isQueried = which & isSilhouette & isNear;
  if (!isQueried.any())
    return surface;
  return querySilhouettes(*medium.silhouette, isQueried, cell, at, medium.clip.softness, surface);
}

HWY_INLINE Float findNearestDepth(const SimdMedium& medium, const ViewPoints& view) {
  const Int c = toInt(depthIndex(medium.clip.depthX, view.x) + 0.5F);
  const Int r = toInt(depthIndex(medium.clip.depthY, view.y) + 0.5F);
  return gather(medium.depths, r * medium.depthColumns + c);
}

/// Distance behind the clip's surface, mm; below 0 in front of it. In silhouette cells exact only
/// for the lanes of `which`.
HWY_INLINE Float signedDistance(const SimdMedium& medium, const Float3& p, const ViewPoints& view,
                                LaneMask which) {
  if (medium.clipKind == SimdMedium::ClipKind::plane)
    return -applyRow(medium.toPlane, p);
  if (medium.clipKind == SimdMedium::ClipKind::depthNearest)
    return view.depth - findNearestDepth(medium, view);
  const Surface surface = interpolateSurface(medium, view);
  return view.depth -
         (medium.silhouette ? refineAtSilhouette(medium, which, surface, view) : surface.depth);
}

/// Clip weight for every kind of clip, valid for the lanes of `which`.
inline Float clipWeight(const SimdMedium& medium, const Float3& p, LaneMask which) {
  const ViewPoints view = mapToView(medium.clip, p);
  const Float weight = edgeWeight(medium.clip.ghost, medium.clip.perSoftness,
                                  signedDistance(medium, p, view, which));
  return select(view.isBehindCamera, 0.0F, weight);
}

/// Gradient of a soft cut, world axes, for the lanes of `which`; 0 in the others.
inline Float3 cutGradient(const SimdMedium& medium, const Float3& p, LaneMask which) {
  const ViewPoints view = mapToView(medium.clip, p);
  const Float behind = signedDistance(medium, p, view, which);
  const LaneMask isRamp = which & (behind >= 0.0F) & (behind < medium.clip.softness);
  const LaneMask isCut = isRamp.without(view.isBehindCamera);
  if (!isCut.any())
    return {0.0F, 0.0F, 0.0F};
  const Float length = medium.cutSlope;
  if (medium.clipKind != SimdMedium::ClipKind::depthLinear)
    return zeroUnless(isCut, length * Float3(medium.cutNormal));
  const Surface surface = interpolateSurface(medium, view);
  const Float3 gradient = distanceGradient(medium.clip.isPerspective != 0, medium.clip.targetDepth,
                                           view, surface.slopeX, surface.slopeY);
  return zeroUnless(isCut, length * normalize(mapDirection(medium.fromView, gradient)));
}
