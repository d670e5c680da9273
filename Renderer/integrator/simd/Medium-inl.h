// Look-ups at points in index space: scalar, extinction, majorant cell, domain.

/// A point along one axis of a grid, clamped in the outer half voxel.
struct AxisPosition {
  Float lower;    ///< index of the voxel below, an integer
  Float fraction; ///< distance from it, 0 to 1
};
HWY_INLINE AxisPosition locateOnAxis(const SimdAxis& a, Float x) {
  // This order of min and max maps NaN to 0.
  const Float inside = max(min(x, a.last), 0.0F);
  const Float lower = min(floor(inside), a.lastCell);
  return {lower, inside - lower};
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

/// Four values per lane, of voxels, rows or slices.
struct LaneQuad {
  Float values[4];

  HWY_INLINE Float& operator[](std::int32_t i) { return values[i]; }
  HWY_INLINE Float operator[](std::int32_t i) const { return values[i]; }
};

/// Each lane's four voxels from its index + `offset` on, along x. All must exist.
template <typename Voxel>
HWY_INLINE LaneQuad loadRow(const SimdField& field, const Indices& index, std::int32_t offset) {
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
  const Float low =
      lerp(lerp(near.first, near.second, f), lerp(above.first, above.second, f), y.fraction);
  const Float high =
      lerp(lerp(behind.first, behind.second, f), lerp(last.first, last.second, f), y.fraction);
  return lerp(low, high, z.fraction);
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

/// Parts of rays, one per lane; t in mm.
struct LaneIntervals {
  Float begin, end;

  /// Intersects with the domain (Domain::clip). Rays are in index space.
  HWY_INLINE void clip(const SimdMedium& medium, const Float3& origin, const Float3& direction) {
    clip(medium.lower, medium.upper, origin, direction);
    if (const std::optional<AffineRows>& toCrop = medium.toCrop)
      clip({-1.0F, -1.0F, -1.0F}, {1.0F, 1.0F, 1.0F}, mapPoint(*toCrop, origin),
           mapDirection(*toCrop, direction));
  }

private:
  /// Intersects with a box. A ray that lies in a face counts as inside.
  HWY_INLINE void clip(const Float3& lower, const Float3& upper, const Float3& origin,
                       const Float3& direction) {
    const auto clipAxis = [&](Float low, Float high, Float o, Float d) {
      constexpr float infinite = std::numeric_limits<float>::infinity();
      const LaneMask isParallel = d == 0.0F, isBackward = d < 0.0F;
      const LaneMask inside = (low <= o) & (o <= high);
      const Float near = (select(isBackward, high, low) - o) / d;
      const Float far = (select(isBackward, low, high) - o) / d;
      begin = max(begin, select(isParallel, select(inside, -infinite, infinite), near));
      end = min(end, select(isParallel, infinite, far));
    };
    clipAxis(lower.x, upper.x, origin.x, direction.x);
    clipAxis(lower.y, upper.y, origin.y, direction.y);
    clipAxis(lower.z, upper.z, origin.z, direction.z);
  }
};

/// Length (mm) of a ray up to the domain's end; 0 if rounding put the origin outside.
HWY_INLINE Float lengthInDomain(const SimdMedium& medium, const Float3& origin,
                                const Float3& direction) {
  LaneIntervals inside{0.0F, std::numeric_limits<float>::infinity()};
  inside.clip(medium, origin, direction);
  return clampZero(inside.end);
}

/// Lanes whose point (index space) lies in the focus, where the context style does not apply.
HWY_INLINE LaneMask isFocus(const SimdMedium::Context& context, const Float3& p) {
  return interpolateScalar<std::uint8_t>(context.focus, mapPoint(context.toFocus, p)) >=
         context.level;
}
