// The medium at points in index space, and the traversal of its majorant cells. The target defines
// loadFloat and loadInt (a word of the scene's tables) and loadVoxel.

FORMULA Float3 loadFloat3(Int at) {
  return Float3(loadFloat(at), loadFloat(at + 1), loadFloat(at + 2));
}
FORMULA Float3 toFloat3(STRUCT(AffineRow) v) {
  return Float3(v[0], v[1], v[2]);
}

/// The eight voxels around a point, and its distances from the lowest one, 0 to 1.
struct VoxelCell {
  Int x0, y0, z0, x1, y1, z1;
  Float3 inside;
};
FORMULA VoxelCell findVoxels(STRUCT(VoxelAxis) axisX, STRUCT(VoxelAxis) axisY,
                             STRUCT(VoxelAxis) axisZ, Float3 p) {
  const AxisPosition x = locateOnAxis(axisX.last, axisX.lastCell, p.x);
  const AxisPosition y = locateOnAxis(axisY.last, axisY.lastCell, p.y);
  const AxisPosition z = locateOnAxis(axisZ.last, axisZ.lastCell, p.z);
  VoxelCell cell;
  cell.x0 = toInt(x.lower);
  cell.y0 = toInt(y.lower);
  cell.z0 = toInt(z.lower);
  cell.x1 = cell.x0 + axisX.step;
  cell.y1 = cell.y0 + axisY.step;
  cell.z1 = cell.z0 + axisZ.step;
  cell.inside = Float3(x.fraction, y.fraction, z.fraction);
  return cell;
}
/// Trilinear between the values of two slices: (0, 0), (1, 0), (0, 1) and (1, 1) of each.
FORMULA Float interpolateCell(Float4 near, Float4 far, Float3 inside) {
  return lerp(interpolate(near[0], near[1], near[2], near[3], inside.x, inside.y),
              interpolate(far[0], far[1], far[2], far[3], inside.x, inside.y), inside.z);
}

/// The scalar, trilinear between voxel centers.
FORMULA Float interpolateScalar(Float3 p) {
  const VoxelCell c = findVoxels(scene.voxelsX, scene.voxelsY, scene.voxelsZ, p);
  Float4 near, far;
  near[0] = loadVoxel(c.x0, c.y0, c.z0);
  near[1] = loadVoxel(c.x1, c.y0, c.z0);
  near[2] = loadVoxel(c.x0, c.y1, c.z0);
  near[3] = loadVoxel(c.x1, c.y1, c.z0);
  far[0] = loadVoxel(c.x0, c.y0, c.z1);
  far[1] = loadVoxel(c.x1, c.y0, c.z1);
  far[2] = loadVoxel(c.x0, c.y1, c.z1);
  far[3] = loadVoxel(c.x1, c.y1, c.z1);
  return interpolateCell(near, far, c.inside);
}

/// Segment of a table that contains a scalar (SimdTable).
struct Segment {
  Int index;
  Float beyondStart; ///< scalar minus the segment's start; not finite in the first segment
};
/// `table`: offset of its seven words: offsets of positions, bins and lines, words per channel;
/// then start of the bins, bins per unit, last bin.
FORMULA Segment findSegment(Int table, Float scalar) {
  const Int positions = loadInt(table);
  const Float s = min(scalar, largestReal); // interpolation can overflow
  const Float bin = (s - loadFloat(table + 4)) * loadFloat(table + 5);
  Segment at;
  at.index = loadInt(loadInt(table + 1) + toInt(max(min(bin, loadFloat(table + 6)), 0.0F)));
  while (s >= loadFloat(positions + at.index + 1))
    at.index = at.index + 1;
  at.beyondStart = s - loadFloat(positions + at.index);
  return at;
}
/// Value of a channel in a segment, clamped to >= 0.
FORMULA Float evalSegment(Int table, Int channel, Segment at) {
  const Int line = loadInt(table + 2) + channel * loadInt(table + 3) + at.index * 2;
  const Float slope = loadFloat(line + 1);
  // Constant segments may begin at -infinity.
  return clampZero(loadFloat(line) + select(slope == 0.0F, 0.0F, at.beyondStart * slope));
}

/// Extinction (mm^-1) of a component at label weight 1.
FORMULA Float evalExtinction(Int component, Float scalar) {
  const Float bin = (scalar - scene.lineStart) * scene.linesPerUnit;
  const Float place = max(min(bin, scene.lastLine), 0.0F);
  const Float first = floor(place);
  const Int line = scene.lines + component * scene.lineWords + toInt(first) * 2;
  const Float rise = loadFloat(line + 1);
  if (isNaN(rise)) { // a knot inside the bin
    const Int table = scene.extinctions + component * tableWords;
    return evalSegment(table, 0, findSegment(table, scalar));
  }
  return clampZero(fma(place - first, rise, loadFloat(line)));
}
FORMULA Float3 evalAlbedo(Int component, Float scalar) {
  const Int table = scene.albedos + component * tableWords;
  const Segment at = findSegment(table, scalar);
  return Float3(evalSegment(table, 0, at), evalSegment(table, 1, at), evalSegment(table, 2, at));
}

/// Differences of the scalar across two voxels along each axis.
FORMULA Float3 centralDifference(Float3 p) {
  const Float x = interpolateScalar(Float3(p.x + 1.0F, p.y, p.z)) -
                  interpolateScalar(Float3(p.x - 1.0F, p.y, p.z));
  const Float y = interpolateScalar(Float3(p.x, p.y + 1.0F, p.z)) -
                  interpolateScalar(Float3(p.x, p.y - 1.0F, p.z));
  const Float z = interpolateScalar(Float3(p.x, p.y, p.z + 1.0F)) -
                  interpolateScalar(Float3(p.x, p.y, p.z - 1.0F));
  return Float3(x, y, z);
}
/// Place of Sobel's four points along an axis.
FORMULA Int sobelPlace(STRUCT(VoxelAxis) axis, STRUCT(SobelAxis) sobel, Int step) {
  return toInt(min(sobel.first + toFloat(step), axis.last));
}
/// Twice Sobel's gradient per voxel, as centralDifference.
FORMULA Float3 sobelDifference(Float3 p) {
  const SobelAxis x = makeSobelAxis(scene.voxelsX.last, scene.voxelsX.lastCell, p.x);
  const SobelAxis y = makeSobelAxis(scene.voxelsY.last, scene.voxelsY.lastCell, p.y);
  const SobelAxis z = makeSobelAxis(scene.voxelsZ.last, scene.voxelsZ.lastCell, p.z);
  Float4 alongX, alongY, means; // of the four slices
  for (Int k = 0; k < 4; ++k) {
    const Int slice = sobelPlace(scene.voxelsZ, z, k);
    Float4 rowsAlongX, rowMeans;
    for (Int j = 0; j < 4; ++j) {
      const Int row = sobelPlace(scene.voxelsY, y, j);
      Float4 voxels4;
      for (Int i = 0; i < 4; ++i)
        voxels4[i] = loadVoxel(sobelPlace(scene.voxelsX, x, i), row, slice);
      rowsAlongX[j] = evalRise(x, voxels4);
      rowMeans[j] = evalMean(x, voxels4);
    }
    alongX[k] = evalMean(y, rowsAlongX);
    alongY[k] = evalRise(y, rowMeans);
    means[k] = evalMean(y, rowMeans);
  }
  return Float3(evalMean(z, alongX), evalMean(z, alongY), evalRise(z, means));
}
/// Gradient of the scalar, in spans of the transfer function per mm; world axes.
FORMULA Float3 evalGradient(Float3 p) {
  countWork(gradientCount);
  Float3 difference;
  if (isSobel != 0)
    difference = sobelDifference(p);
  else
    difference = centralDifference(p);
  return mapDirection(scene.toGradient, difference);
}

FORMULA Bsdf loadBsdf(Int component) {
  const Int at = scene.bsdfs + component * bsdfWords;
  Bsdf bsdf;
  bsdf.g = loadFloat(at);
  bsdf.diffuse = loadFloat(at + 1);
  bsdf.specular = loadFloat(at + 2);
  bsdf.f0 = loadFloat(at + 3);
  bsdf.oddsFactor = loadFloat(at + 4);
  bsdf.roughness = loadFloat(at + 5);
  for (Int i = 0; i < 4; ++i)
    bsdf.coat[i] = loadFloat(at + 6 + i);
  bsdf.isCoated = isCoated != 0;
  return bsdf;
}

/// Part of a ray (index space) inside the domain.
FORMULA LaneIntervals clipToDomain(LaneIntervals t, Float3 origin, Float3 direction) {
  t = clipToSlab(t, scene.lower[0], scene.upper[0], origin.x, direction.x);
  t = clipToSlab(t, scene.lower[1], scene.upper[1], origin.y, direction.y);
  t = clipToSlab(t, scene.lower[2], scene.upper[2], origin.z, direction.z);
  if (isCropped != 0) {
    const Float3 o = mapPoint(scene.toCrop, origin);
    const Float3 d = mapDirection(scene.toCrop, direction);
    t = clipToSlab(t, -1.0F, 1.0F, o.x, d.x);
    t = clipToSlab(t, -1.0F, 1.0F, o.y, d.y);
    t = clipToSlab(t, -1.0F, 1.0F, o.z, d.z);
  }
  return t;
}
/// Length of a ray up to the domain's end; 0 if rounding put the origin outside.
FORMULA Float lengthInDomain(Float3 origin, Float3 direction) {
  LaneIntervals t;
  t.begin = 0.0F;
  t.end = infiniteReal;
  return clampZero(clipToDomain(t, origin, direction).end);
}

/// A ray's traversal of majorant cells.
struct Walk {
  DdaAxis x, y, z;
};
FORMULA DdaAxis makeAxis(STRUCT(CellAxis) axis, Float origin, Float direction) {
  return makeDdaAxis(axis.cellsPerVoxel, axis.insideCells, origin, direction);
}
FORMULA Walk makeWalk(Float3 origin, Float3 direction) {
  Walk walk;
  walk.x = makeAxis(scene.cellsX, origin.x, direction.x);
  walk.y = makeAxis(scene.cellsY, origin.y, direction.y);
  walk.z = makeAxis(scene.cellsZ, origin.z, direction.z);
  return walk;
}
/// Point at t mm, index space.
FORMULA Float3 pointAt(STRUCT(Walk) walk, Float t) {
  return Float3(fms(positionAt(walk.x, t), scene.cellsX.cellEdge, 0.5F),
                fms(positionAt(walk.y, t), scene.cellsY.cellEdge, 0.5F),
                fms(positionAt(walk.z, t), scene.cellsZ.cellEdge, 0.5F));
}

/// Majorant cell (SimdMajorants) at t, and the t at which the ray leaves it and all cells within
/// its skip radius.
struct Cell {
  Float majorant; ///< mm^-1
  Float exit;     ///< mm
  LaneMask isCut;
};
FORMULA Cell findCell(STRUCT(Walk) walk, Float t) {
  const Float x = floor(positionAt(walk.x, t));
  const Float y = floor(positionAt(walk.y, t));
  const Float z = floor(positionAt(walk.z, t));
  const Float place =
      fma(z, scene.cellsZ.cellStride, fma(y, scene.cellsY.cellStride, x + scene.firstCell));
  // This order of min and max maps NaN to 0.
  const Int code = loadInt(scene.cells + toInt(max(min(place, scene.endCell), 0.0F)));
  const Float reach = toFloat(code & 0xff) + 0.5F;
  Cell cell;
  cell.majorant = bitsAsFloat(code & 0x7fffff00);
  cell.isCut = code < 0;
  cell.exit = min(min(exitDistance(walk.x, x, reach), exitDistance(walk.y, y, reach)),
                  exitDistance(walk.z, z, reach));
  return cell;
}
