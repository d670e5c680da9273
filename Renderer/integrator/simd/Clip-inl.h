// Clip weight and the gradient of a soft cut at points in index space (SIMD clip/field/Clip.h).

/// Continuous index, among a depth buffer's samples, of a coordinate in mm (DepthAxis::index).
HWY_INLINE Float depthIndex(const SimdMedium::DepthAxis& axis, Float coordinate) {
  const Float pixel = fms(coordinate, axis.perPitch, axis.start);
  const Float fine = max(min(pixel, axis.lastInside), 0.0F);
  const Float index = fma(pixel - fine, axis.perFactor, fine + axis.before);
  return max(min(index, axis.last), 0.0F);
}

/// Points in view space.
struct ViewPoints {
  Float x, y;              ///< as toBuffer's; 0 for a plane
  Float depth;             ///< relative to the target, mm
  Float scale;             ///< target's depth / depth; 1 in orthographic views
  LaneMask isBehindCamera; ///< none in orthographic views
};

HWY_INLINE ViewPoints mapToView(const SimdMedium& medium, const Float3& p) {
  ViewPoints at{0.0F, 0.0F, applyRow(medium.toView[2], p), 1.0F, LaneMask::none()};
  if (medium.perspective) {
    const Float fromCamera = at.depth + medium.targetDepth;
    at.isBehindCamera = fromCamera <= 0.0F;
    at.scale = medium.targetDepth / fromCamera;
  }
  if (medium.clipKind == SimdMedium::ClipKind::plane)
    return at;
  at.x = applyRow(medium.toView[0], p) * at.scale;
  at.y = applyRow(medium.toView[1], p) * at.scale;
  return at;
}

/// Slope of a surface along one axis of the buffer, mm per mm, from its `rise` across a cell; 0 at
/// the first sample and outside the samples.
HWY_INLINE Float axisSlope(const SimdMedium::DepthAxis& axis, Float index, Float rise) {
  const Float before = axis.before;
  const LaneMask isFine = (index >= before) & (index < before + axis.lastInside);
  const LaneMask isBetween = (index > 0.0F) & (index < axis.last);
  const Float perLength = select(isFine, axis.perPitch, axis.perPitch * axis.perFactor);
  return zeroUnless(isBetween, rise * perLength);
}

/// A surface between four samples of the depth buffer.
struct Surface {
  Int sample;           ///< index of the top-left sample
  Float depth;          ///< relative to the target, mm
  Float slopeX, slopeY; ///< mm per mm
};
HWY_INLINE Surface interpolateSurface(const SimdMedium& medium, const ViewPoints& view) {
  const Float column = depthIndex(medium.depthX, view.x);
  const Float row = depthIndex(medium.depthY, view.y);
  const Int columns = medium.depthColumns;
  const Int c0 = toInt(column);
  const Int r0 = toInt(row);
  const Int c1 = min(c0 + 1, toInt(medium.depthX.last));
  const Int r1 = min(r0 + 1, toInt(medium.depthY.last));
  const Float fc = column - toFloat(c0);
  const Float fr = row - toFloat(r0);
  const auto at = [&](Int c, Int r) { return gather(medium.depths, r * columns + c); };
  const Float upLeft = at(c0, r0), upRight = at(c1, r0);
  const Float downLeft = at(c0, r1), downRight = at(c1, r1);
  return {r0 * columns + c0, lerp(lerp(upLeft, upRight, fc), lerp(downLeft, downRight, fc), fr),
          axisSlope(medium.depthX, column, lerp(upRight - upLeft, downRight - downLeft, fr)),
          axisSlope(medium.depthY, row, lerp(downLeft - upLeft, downRight - upRight, fc))};
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
  const LaneMask isNear = (at.depth >= nearest) & (at.depth <= farthest + medium.softness);
  const LaneMask isQueried = which & isSilhouette & isNear;
  if (!isQueried.any())
    return surface;
  return querySilhouettes(*medium.silhouette, isQueried, cell, at, medium.softness, surface);
}

HWY_INLINE Float findNearestDepth(const SimdMedium& medium, const ViewPoints& view) {
  const Int c = toInt(depthIndex(medium.depthX, view.x) + 0.5F);
  const Int r = toInt(depthIndex(medium.depthY, view.y) + 0.5F);
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
  const ViewPoints view = mapToView(medium, p);
  const Float behind = signedDistance(medium, p, view, which);
  const Float ghost = medium.ghost;
  const Float rise = medium.perSoftness > 0.0F ? min(behind * medium.perSoftness, 1.0F) : 1.0F;
  const Float weight = select(behind < 0.0F, ghost, lerp(ghost, 1.0F, rise));
  return select(view.isBehindCamera, 0.0F, weight);
}

/// Gradient of the distance behind a surface, along the view's axes.
HWY_INLINE Float3 distanceGradient(const SimdMedium& medium, const ViewPoints& view,
                                   const Surface& surface) {
  const Float x = surface.slopeX, y = surface.slopeY;
  if (!medium.perspective)
    return {-x, -y, 1.0F};
  const Float perDepth = view.scale / medium.targetDepth;
  const Float along = fma(x, view.x, y * view.y);
  return {-(x * view.scale), -(y * view.scale), fma(along, perDepth, 1.0F)};
}

/// Gradient of a soft cut, world axes, for the lanes of `which`; 0 in the others.
inline Float3 cutGradient(const SimdMedium& medium, const Float3& p, LaneMask which) {
  const ViewPoints view = mapToView(medium, p);
  const Float behind = signedDistance(medium, p, view, which);
  const LaneMask isRamp = which & (behind >= 0.0F) & (behind < medium.softness);
  const LaneMask isCut = isRamp.without(view.isBehindCamera);
  if (!isCut.any())
    return {0.0F, 0.0F, 0.0F};
  const Float length = medium.cutSlope;
  if (medium.clipKind != SimdMedium::ClipKind::depthLinear)
    return zeroUnless(isCut, length * Float3(medium.cutNormal));
  const Float3 gradient = distanceGradient(medium, view, interpolateSurface(medium, view));
  return zeroUnless(isCut, length * normalize(mapDirection(medium.fromView, gradient)));
}
