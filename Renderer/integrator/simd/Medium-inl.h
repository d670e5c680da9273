// Look-ups at points in index space: scalar, extinction, majorant cell, domain.

#include "formulas/Interpolation.inl"
#include "formulas/Tracking.inl"

HWY_INLINE AxisPosition locateOnAxis(const SimdAxis& a, Float x) {
  return locateOnAxis(a.last, a.lastCell, x);
}
/// Offset of a voxel or brick in its array.
HWY_INLINE Int voxelOffset(const SimdAxes& axes, Float x, Float y, Float z) {
  return nonNegativeToInt(x) + nonNegativeToInt(y) * axes[1].stride +
         nonNegativeToInt(z) * axes[2].stride;
}

/// Each lane's voxel at `first` + `offset`, and its neighbor along x.
template <typename Voxel>
HWY_INLINE Pairs loadVoxels(const SimdField& field, Int first, const Indices& index,
                            std::int32_t offset) {
  const auto* const voxels = static_cast<const Voxel*>(field.voxels);
  if constexpr (std::is_same_v<Voxel, float>) {
    return loadPairs(voxels + offset, index);
  } else if constexpr (std::is_same_v<Voxel, std::int16_t>) {
    const Int both = loadInts(voxels + offset, index);
    return {toFloat(shiftRight<16>(shiftLeft<16>(both))), toFloat(shiftRight<16>(both))};
  } else if constexpr (std::is_same_v<Voxel, std::uint16_t>) {
    const Int both = loadInts(voxels + offset, index);
    return {toFloat(both & 0xffff), toFloat(shiftRight<16>(both) & 0xffff)};
  } else { // reads four bytes, but none past the last voxel
    const Int row = first + offset;
    const Int from = min(row, static_cast<std::int32_t>(field.count - 4));
    const Int four = loadInts(voxels, Indices(from));
    const Int both = hn::Shr(four.v, shiftLeft<3>(row - from).v);
    return {toFloat(both & 0xff), toFloat(shiftRight<8>(both) & 0xff)};
  }
}

/// Each lane's four voxels from its index + `offset` on, along x. All must exist.
template <typename Voxel>
HWY_INLINE Float4 loadRow(const SimdField& field, const Indices& index, std::int32_t offset) {
  const auto* const voxels = static_cast<const Voxel*>(field.voxels) + offset;
  if constexpr (std::is_same_v<Voxel, float>) {
    const Pairs low = loadPairs(voxels, index), high = loadPairs(voxels + 2, index);
    return {{low.first, low.second, high.first, high.second}};
  } else if constexpr (std::is_same_v<Voxel, std::uint8_t>) {
    const Int four = loadInts(voxels, index);
    return {{toFloat(four & 0xff), toFloat(shiftRight<8>(four) & 0xff),
             toFloat(shiftRight<16>(four) & 0xff), toFloat(shiftRight<24>(four) & 0xff)}};
  } else { // 16 bits
    const Pairs both = loadPairs(voxels, index);
    const Int low = bitsAsInt(both.first), high = bitsAsInt(both.second);
    if constexpr (std::is_signed_v<Voxel>)
      return {{toFloat(shiftRight<16>(shiftLeft<16>(low))), toFloat(shiftRight<16>(low)),
               toFloat(shiftRight<16>(shiftLeft<16>(high))), toFloat(shiftRight<16>(high))}};
    else
      return {{toFloat(low & 0xffff), toFloat(shiftRight<16>(low) & 0xffff), toFloat(high & 0xffff),
               toFloat(shiftRight<16>(high) & 0xffff)}};
  }
}

/// The scalar, trilinear between voxel centers.
template <typename Voxel>
HWY_INLINE Float interpolateScalar(const SimdField& field, const Float3& p) {
  const SimdAxes& axes = field.axes;
  const AxisPosition x = locateOnAxis(axes[0], p.x);
  const AxisPosition y = locateOnAxis(axes[1], p.y);
  const AxisPosition z = locateOnAxis(axes[2], p.z);
  const Int first = voxelOffset(axes, x.lower, y.lower, z.lower);
  const Indices index(first);
  const std::int32_t up = axes[1].stride, deep = axes[2].stride;
  const Pairs near = loadVoxels<Voxel>(field, first, index, 0);
  const Pairs above = loadVoxels<Voxel>(field, first, index, up);
  const Pairs behind = loadVoxels<Voxel>(field, first, index, deep);
  const Pairs last = loadVoxels<Voxel>(field, first, index, deep + up);
  const Float f = x.fraction;
  return lerp(interpolate(near.first, near.second, above.first, above.second, f, y.fraction),
              interpolate(behind.first, behind.second, last.first, last.second, f, y.fraction),
              z.fraction);
}

/// The segment of a table that contains a scalar.
struct Segment {
  Int index;
  Float beyondStart; ///< scalar minus the segment's start; not finite in the first segment
};

HWY_INLINE Segment findSegment(const SimdTable& table, Float s) {
  s = min(s, std::numeric_limits<float>::max()); // interpolation can overflow
  const auto lastBin = static_cast<float>(table.binSegment.size() - 1);
  const Float bin = (s - table.binStart) * table.binsPerUnit;
  Int segment = gather(table.binSegment.data(), toInt(max(min(bin, lastBin), 0.0F)));
  for (;;) {
    const Pairs ends = loadPairs(table.position.data(), Indices(segment));
    const LaneMask beyond = s >= ends.second;
    if (!beyond.any())
      return {segment, s - ends.first};
    segment.setIf(beyond, segment + 1);
  }
}

/// Value of a channel in a segment, clamped to >= 0.
HWY_INLINE Float evalSegment(const SimdTable::Channel& channel, const Segment& at) {
  const auto [value, slope] = loadPairs(&channel[0].value, Indices(shiftLeft<1>(at.index)));
  // Constant segments may begin at -infinity.
  return clampZero(value + select(slope == 0.0F, 0.0F, at.beyondStart * slope));
}

HWY_INLINE Float evalTable(const SimdTable& table, Float s) {
  return evalSegment(table.channels[0], findSegment(table, s));
}

/// Values of SimdLines, one load per lane; invalid where a lane's bin contains a knot.
struct LineValue {
  Float value;
  LaneMask hasKnot;
};
/// `first`: index of each lane's first line.
HWY_INLINE LineValue evalLines(const SimdLines& table, Int first, Float s) {
  const Float place = max(min((s - table.start) * table.binsPerUnit, table.last), 0.0F);
  const Float line = floor(place);
  const auto [value, rise] =
      loadPairs(&table.lines[0].value, Indices(shiftLeft<1>(first + nonNegativeToInt(line))));
  return {clampZero(fma(place - line, rise, value)), ~(rise == rise)}; // NaN: a knot
}

/// Extinction (mm^-1) of a scalar, for media without mixture.
HWY_INLINE Float evalExtinction(const SimdLines& table, Float s) {
  const auto [value, hasKnot] = evalLines(table, 0, s);
  return hasKnot.any() ? select(hasKnot, evalTable(table.segments[0], s), value) : value;
}

/// Majorant cells, one per lane (SimdMajorants).
struct LaneCells {
  Float majorant;   ///< mm^-1
  Float skipRadius; ///< cells
  LaneMask isCut;
};

/// Cells with these indices along the axes: integers, from -1 (border) to the count (border).
HWY_INLINE LaneCells loadCells(const SimdMedium& medium, Float x, Float y, Float z) {
  const Float place =
      fma(z, medium.axes[2].cellStride, fma(y, medium.axes[1].cellStride, x + medium.firstCell));
  // This order of min and max maps NaN to 0.
  const Int index = nonNegativeToInt(max(min(place, medium.lastCell), 0.0F));
  const Int code = gather(medium.cells.codes.data(), index);
  return {bitsAsFloat(code & SimdMajorants::majorantBits),
          toFloat(code & SimdMajorants::radiusBits), code < 0};
}

/// A ray's traversal along one axis, from its origin and direction there (index space).
HWY_INLINE DdaAxis makeDdaAxis(const SimdMedium::Axis& axis, Float origin, Float direction) {
  return makeDdaAxis(axis.cellsPerVoxel, axis.insideCells, origin, direction);
}
/// t at which rays leave their cell and all cells within its skip radius. `cell` receives the cell.
HWY_INLINE Float findCellExit(const SimdMedium& scene, const DdaAxis (&axes)[3], Float t,
                              LaneCells& cell) {
  const Float x = floor(positionAt(axes[0], t));
  const Float y = floor(positionAt(axes[1], t));
  const Float z = floor(positionAt(axes[2], t));
  cell = loadCells(scene, x, y, z);
  const Float reach = cell.skipRadius + 0.5F;
  return min(min(exitDistance(axes[0], x, reach), exitDistance(axes[1], y, reach)),
             exitDistance(axes[2], z, reach));
}

/// Intersects rays, in index space, with the domain (Domain::clip).
HWY_INLINE LaneIntervals clipToDomain(const SimdMedium& medium, LaneIntervals t,
                                      const Float3& origin, const Float3& direction) {
  const auto clip = [&](const auto& lower, const auto& upper, const Float3& o, const Float3& d) {
    t = clipToSlab(t, lower[0], upper[0], o.x, d.x);
    t = clipToSlab(t, lower[1], upper[1], o.y, d.y);
    t = clipToSlab(t, lower[2], upper[2], o.z, d.z);
  };
  clip(medium.lower, medium.upper, origin, direction);
  constexpr float edge[3] = {1.0F, 1.0F, 1.0F}, opposite[3] = {-1.0F, -1.0F, -1.0F};
  if (const std::optional<AffineRows>& toCrop = medium.toCrop)
    clip(opposite, edge, mapPoint(*toCrop, origin), mapDirection(*toCrop, direction));
  return t;
}

/// Length (mm) of a ray up to the domain's end; 0 if rounding put the origin outside.
HWY_INLINE Float lengthInDomain(const SimdMedium& medium, const Float3& origin,
                                const Float3& direction) {
  return clampZero(clipToDomain(medium, {0.0F, infiniteReal}, origin, direction).end);
}

/// Lanes whose point (index space) lies in the focus, where the context style does not apply.
HWY_INLINE LaneMask isFocus(const SimdMedium::Context& context, const Float3& p) {
  return interpolateScalar<std::uint8_t>(context.focus, mapPoint(context.toFocus, p)) >=
         context.level;
}
