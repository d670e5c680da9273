// The clip at points in index space: integrator/simd/Clip-inl.h for one path.

CONSTANT Int clipNone = 0; ///< SimdMedium::ClipKind
CONSTANT Int clipPlane = 1;
CONSTANT Int clipDepthLinear = 2;
CONSTANT Int clipDepthNearest = 3;

/// The surface between four samples of the depth buffer: depth, mm, and slopes, mm per mm.
struct Surface {
  Float depth, slopeX, slopeY;
  Int first; ///< index of the top-left sample
};
FORMULA Float loadDepth(Int column, Int row) {
  return loadFloat(scene.depths + row * scene.depthColumns + column);
}
FORMULA Surface interpolateSurface(STRUCT(ViewPoints) view) {
  const Float column = depthIndex(scene.clip.depthX, view.x);
  const Float row = depthIndex(scene.clip.depthY, view.y);
  const Int c0 = toInt(column);
  const Int r0 = toInt(row);
  const Int c1 = toInt(min(toFloat(c0) + 1.0F, scene.clip.depthX.last));
  const Int r1 = toInt(min(toFloat(r0) + 1.0F, scene.clip.depthY.last));
  const Float fc = column - toFloat(c0);
  const Float fr = row - toFloat(r0);
  const Float upLeft = loadDepth(c0, r0);
  const Float upRight = loadDepth(c1, r0);
  const Float downLeft = loadDepth(c0, r1);
  const Float downRight = loadDepth(c1, r1);
  Surface surface;
  surface.first = r0 * scene.depthColumns + c0;
  surface.depth = interpolate(upLeft, upRight, downLeft, downRight, fc, fr);
  surface.slopeX =
      axisSlope(scene.clip.depthX, column, lerp(upRight - upLeft, downRight - downLeft, fr));
  surface.slopeY =
      axisSlope(scene.clip.depthY, row, lerp(downLeft - upLeft, downRight - upRight, fc));
  return surface;
}

/// Depth of the surface. In silhouette cells (SilhouetteCells) it is exact if a point at `depth`
/// can lie on it or within its soft edge; infinity: exact at all depths.
FORMULA Float refineAtSilhouette(STRUCT(Surface) surface, STRUCT(ViewPoints) view, Float depth) {
  const Int cell = loadInt(scene.silhouetteCells + surface.first);
  if (cell < 0)
    return surface.depth;
  const Int bounds = scene.silhouettes + cell * silhouetteWords;
  const Float nearest = min(surface.depth, loadFloat(bounds));
  const Float farthest = max(surface.depth, loadFloat(bounds + 1));
  const LaneMask isAlways = depth == infiniteReal;
  if (!isAlways && (depth < nearest || depth > farthest + scene.clip.softness))
    return surface.depth;
  return querySilhouette(cell, view.x, view.y, surface.depth,
                         isAlways ? -infiniteReal : depth - scene.clip.softness);
}

/// Distance behind the clip's surface, mm; below 0 in front of it. `depth`: refineAtSilhouette's.
FORMULA Float signedDistance(Float3 p, STRUCT(ViewPoints) view, Float depth) {
  if (clipKind == clipPlane)
    return -applyRow(scene.toPlane, p);
  if (clipKind == clipDepthNearest)
    return view.depth - loadDepth(toInt(depthIndex(scene.clip.depthX, view.x) + 0.5F),
                                  toInt(depthIndex(scene.clip.depthY, view.y) + 0.5F));
  const Surface surface = interpolateSurface(view);
  if (hasSilhouettes != 0)
    return view.depth - refineAtSilhouette(surface, view, depth);
  return view.depth - surface.depth;
}

FORMULA Float clipWeight(Float3 p) {
  const ViewPoints view = mapToView(scene.clip, p);
  if (view.isBehindCamera)
    return 0.0F;
  return edgeWeight(scene.clip.ghost, scene.clip.perSoftness, signedDistance(p, view, view.depth));
}

/// Gradient of a soft cut, world axes; 0 outside the ramp of its edge.
FORMULA Float3 cutGradient(Float3 p) {
  const ViewPoints view = mapToView(scene.clip, p);
  const Float behind = signedDistance(p, view, view.depth);
  if (view.isBehindCamera || behind < 0.0F || behind >= scene.clip.softness)
    return Float3(0.0F, 0.0F, 0.0F);
  if (clipKind != clipDepthLinear)
    return scene.cutSlope * toFloat3(scene.cutNormal);
  const Surface surface = interpolateSurface(view);
  const Float3 gradient = distanceGradient(scene.clip.isPerspective != 0, scene.clip.targetDepth,
                                           view, surface.slopeX, surface.slopeY);
  return scene.cutSlope * normalize(mapDirection(scene.fromView, gradient));
}

/// Part of a camera ray on which the clip weight can be above 0, for a weight of 0 in front of the
/// surface. All points of the ray lie at the same place of a depth buffer.
FORMULA LaneIntervals findVisible(Float3 origin, Float3 ray, Float depthPerLength) {
  const ViewPoints view = mapToView(scene.clip, origin);
  const Float behind = signedDistance(origin, view, infiniteReal);
  Float rise = depthPerLength; // of the distance behind the surface, per mm
  if (clipKind == clipPlane)
    rise = -applyLinearRow(scene.toPlane, ray);
  const Float crossing = max(-behind / rise, 0.0F);
  LaneIntervals visible;
  visible.begin = 0.0F;
  visible.end = infiniteReal;
  if (rise > 0.0F)
    visible.begin = crossing;
  else if (rise < 0.0F)
    visible.end = crossing;
  else if (behind < 0.0F)
    visible.end = 0.0F;
  return visible;
}
