// Clip weight at points, and the normal of a soft cut (clip/field/Clip.h). With D the depth of the
// surface, its gradient of the distance behind is, along the axes of the view,
//   (-D_x, -D_y, 1)                                           orthographic,
//   (-s D_x, -s D_y, 1 + (x D_x + y D_y) / z), s = target depth / z   perspective.

/// Points in view space.
struct ViewPoints {
  Float x, y;              ///< as toBuffer's
  Float depth;             ///< relative to the target, mm
  Float scale;             ///< target's depth / depth; 1 in orthographic views
  LaneMask isBehindCamera; ///< none in orthographic views
};
/// `p`: index space.
FORMULA ViewPoints mapToView(STRUCT(ClipTable) clip, Float3 p) {
  ViewPoints at;
  at.depth = applyRow(clip.toView[2], p);
  at.scale = 1.0F;
  at.isBehindCamera = noLanes();
  if (clip.isPerspective != 0) {
    const Float fromCamera = at.depth + clip.targetDepth;
    at.isBehindCamera = fromCamera <= 0.0F;
    at.scale = clip.targetDepth / fromCamera;
  }
  at.x = applyRow(clip.toView[0], p) * at.scale;
  at.y = applyRow(clip.toView[1], p) * at.scale;
  return at;
}

/// Continuous index, among a depth buffer's samples, of a coordinate in mm (DepthAxis::index).
FORMULA Float depthIndex(STRUCT(DepthTable) axis, Float coordinate) {
  const Float pixel = fms(coordinate, axis.perPitch, axis.start);
  const Float fine = max(min(pixel, axis.lastInside), 0.0F);
  const Float index = fma(pixel - fine, axis.perFactor, fine + axis.before);
  return max(min(index, axis.last), 0.0F);
}

/// Slope of a surface along one axis of the buffer, mm per mm, from its `rise` across a cell; 0 at
/// the first sample and outside the samples.
FORMULA Float axisSlope(STRUCT(DepthTable) axis, Float index, Float rise) {
  const LaneMask isFine = both(index >= axis.before, index < axis.before + axis.lastInside);
  const LaneMask isBetween = both(index > 0.0F, index < axis.last);
  const Float perLength = select(isFine, axis.perPitch, axis.perPitch * axis.perFactor);
  return zeroUnless(isBetween, rise * perLength);
}

/// Weight `behind` mm behind the surface (ClipEdge); perSoftness: 1 / mm, or 0 for a sharp edge.
FORMULA Float edgeWeight(Real ghost, Real perSoftness, Float behind) {
  Float rise = 1.0F;
  if (perSoftness > 0.0F)
    rise = min(behind * perSoftness, 1.0F);
  return select(behind < 0.0F, ghost, lerp(ghost, 1.0F, rise));
}

/// Gradient of the distance behind a surface of the given slopes, along the view's axes.
FORMULA Float3 distanceGradient(bool isPerspective, Real targetDepth, STRUCT(ViewPoints) view,
                                Float slopeX, Float slopeY) {
  if (!isPerspective)
    return Float3(-slopeX, -slopeY, 1.0F);
  const Float perDepth = view.scale / targetDepth;
  const Float along = fma(slopeX, view.x, slopeY * view.y);
  return Float3(-(slopeX * view.scale), -(slopeY * view.scale), fma(along, perDepth, 1.0F));
}
