// Label weights at points in index space: integrator/simd/LabelWeights-inl.h for one path. The
// target defines loadByte (of the scene's tables).

/// Weights of one plane at the eight voxels around a point, 0 to 255.
struct CornerWeights {
  Float4 near, far; ///< (0, 0), (1, 0), (0, 1), (1, 1) of either slice
};
FORMULA Float4 loadSlice(Int at) {
  Float4 slice;
  slice[0] = toFloat(loadByte(at));
  slice[1] = toFloat(loadByte(at + 1));
  slice[2] = toFloat(loadByte(at + brickVoxels));
  slice[3] = toFloat(loadByte(at + brickVoxels + 1));
  return slice;
}
FORMULA Float interpolateWeights(STRUCT(CornerWeights) weights, Float3 inside) {
  return interpolateCell(weights.near, weights.far, inside) * 0.003921568859F; // 1 / 255
}

/// Visits the components at a point; `component` and `fraction` are those of the current one.
struct LabelCursor {
  Int component;
  Float fraction;     ///< label weight, above 0
  Int plane;          ///< byte of the next plane of a mixed brick; -1: only the remainder is left
  Int voxel;          ///< the lowest of the eight, within its brick
  Float3 inside;      ///< distances from it, 0 to 1
  CornerWeights rest; ///< of the component that gets the remainder
  Int restComponent;
  LaneMask isPure; ///< the brick has one component alone
  LaneMask isDone;
};
/// `bricks`: offset of LabelWeights::bricks().
FORMULA LabelCursor findLabels(Int bricks, Float3 index) {
  const Float3 p = mapPoint(scene.toWeights, index);
  const AxisPosition x = locateOnAxis(scene.weightsX.last, scene.weightsX.lastCell, p.x);
  const AxisPosition y = locateOnAxis(scene.weightsY.last, scene.weightsY.lastCell, p.y);
  const AxisPosition z = locateOnAxis(scene.weightsZ.last, scene.weightsZ.lastCell, p.z);
  const Int i = toInt(x.lower);
  const Int j = toInt(y.lower);
  const Int k = toInt(z.lower);
  const Int brick = (i >> 2) * scene.weightsX.step + (j >> 2) * scene.weightsY.step +
                    (k >> 2) * scene.weightsZ.step;
  const Int code = loadInt(bricks + brick);
  LabelCursor cursor;
  cursor.component = 0;
  cursor.fraction = 0.0F;
  cursor.isPure = code >= 0;
  cursor.plane = cursor.isPure ? -1 : scene.planes * 4 + ~code * planeBytes;
  cursor.voxel = ((k & 3) * brickVoxels + (j & 3)) * brickVoxels + (i & 3);
  cursor.inside = Float3(x.fraction, y.fraction, z.fraction);
  for (Int c = 0; c < 4; ++c) {
    cursor.rest.near[c] = 255.0F;
    cursor.rest.far[c] = 255.0F;
  }
  cursor.restComponent = code;
  cursor.isDone = noLanes();
  return cursor;
}
/// Moves to the next component; false if there is none.
FORMULA bool nextLabel(INOUT(LabelCursor) cursor) {
  while (cursor.plane >= 0) {
    const Int at = cursor.plane;
    CornerWeights weights;
    weights.near = loadSlice(at + cursor.voxel);
    weights.far = loadSlice(at + cursor.voxel + brickVoxels * brickVoxels);
    for (Int c = 0; c < 4; ++c) {
      cursor.rest.near[c] = cursor.rest.near[c] - weights.near[c];
      cursor.rest.far[c] = cursor.rest.far[c] - weights.far[c];
    }
    cursor.component = loadByte(at + planeBytes - 3);
    cursor.restComponent = loadByte(at + planeBytes - 2);
    cursor.plane = loadByte(at + planeBytes - 1) != 0 ? -1 : at + planeBytes;
    cursor.fraction = interpolateWeights(weights, cursor.inside);
    if (cursor.fraction > 0.0F)
      return true;
  }
  if (cursor.isDone)
    return false;
  cursor.isDone = allLanes();
  cursor.component = cursor.restComponent;
  cursor.fraction = cursor.isPure ? 1.0F : interpolateWeights(cursor.rest, cursor.inside);
  return cursor.fraction > 0.0F;
}

/// componentKind of segments that differ in albedo only, and of a mixture (Features).
CONSTANT Int tinted = 1;
CONSTANT Int mixed = 2;

FORMULA LaneMask isUnclipped(Int component) {
  if (hasUnclipped != 0)
    return loadInt(scene.unclipped + component) != 0;
  return noLanes();
}

/// True in the focus, where the context style does not apply.
FORMULA bool isFocus(Float3 index) {
  const VoxelCell c =
      findVoxels(scene.focusX, scene.focusY, scene.focusZ, mapPoint(scene.toFocus, index));
  Float4 near, far;
  near[0] = loadFocus(c.x0, c.y0, c.z0);
  near[1] = loadFocus(c.x1, c.y0, c.z0);
  near[2] = loadFocus(c.x0, c.y1, c.z0);
  near[3] = loadFocus(c.x1, c.y1, c.z0);
  far[0] = loadFocus(c.x0, c.y0, c.z1);
  far[1] = loadFocus(c.x1, c.y0, c.z1);
  far[2] = loadFocus(c.x0, c.y1, c.z1);
  far[3] = loadFocus(c.x1, c.y1, c.z1);
  return interpolateCell(near, far, c.inside) >= scene.focusLevel;
}

/// Extinction (mm^-1) of the components that the clip can remove, and of the others.
struct Extinctions {
  Float clipped, unclipped;
};
FORMULA Extinctions evalExtinctions(Float3 index, Float scalar) {
  Extinctions sums;
  sums.clipped = 0.0F;
  sums.unclipped = 0.0F;
  if (componentKind == mixed) {
    LabelCursor cursor = findLabels(scene.mergedBricks, index);
    while (nextLabel(cursor)) {
      const Float part = cursor.fraction * evalExtinction(cursor.component, scalar);
      if (isUnclipped(cursor.component))
        sums.unclipped = sums.unclipped + part;
      else
        sums.clipped = sums.clipped + part;
    }
  } else {
    sums.clipped = evalExtinction(0, scalar);
  }
  if (hasContext != 0 && scene.contextExtinction != 1.0F && !isFocus(index)) {
    sums.clipped = sums.clipped * scene.contextExtinction;
    sums.unclipped = sums.unclipped * scene.contextExtinction;
  }
  return sums;
}

/// Samples the component of a mixture at a collision; 0 in other media. u: uniform in (0, 1].
FORMULA Int sampleComponent(Float3 index, Float scalar, Float u) {
  Float weight = 1.0F; // if all components are clipped, it cancels
  if (hasUnclipped != 0 && clipKind != clipNone)
    weight = clipWeight(index);
  Float sum = 0.0F;
  LabelCursor cursor = findLabels(scene.bricks, index);
  while (nextLabel(cursor)) {
    const Float full = cursor.fraction * evalExtinction(cursor.component, scalar);
    sum = sum + (isUnclipped(cursor.component) ? full : weight * full);
  }
  Float left = u * sum;
  Int sampled = 0;
  cursor = findLabels(scene.bricks, index);
  while (nextLabel(cursor)) {
    const Float full = cursor.fraction * evalExtinction(cursor.component, scalar);
    const Float part = isUnclipped(cursor.component) ? full : weight * full;
    if (part > 0.0F)
      sampled = cursor.component; // the last component, if rounding skips all
    if (part > 0.0F && left < part)
      return sampled;
    left = left - part;
  }
  return sampled;
}

/// Albedo at a collision with a component, under the context's style.
FORMULA Float3 evalAlbedoAt(Float3 index, Int component, Float scalar) {
  Float3 albedo = Float3(0.0F, 0.0F, 0.0F);
  if (componentKind == tinted) {
    LabelCursor cursor = findLabels(scene.bricks, index);
    Float total = 0.0F;
    while (nextLabel(cursor)) {
      const Float weight = colorWeight(cursor.fraction);
      albedo = albedo + weight * evalAlbedo(cursor.component, scalar);
      total = total + weight;
    }
    albedo = 1.0F / total * albedo;
  } else {
    albedo = evalAlbedo(component, scalar);
  }
  if (hasContext != 0 && !isFocus(index)) {
    const Float gray = dot(albedo, Float3(0.2126F, 0.7152F, 0.0722F));
    const Float saturation = scene.contextSaturation;
    albedo = Float3(lerp(gray, albedo.x, saturation), lerp(gray, albedo.y, saturation),
                    lerp(gray, albedo.z, saturation));
  }
  return albedo;
}
