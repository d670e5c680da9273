// Label weights of components at points in index space.

/// Calls visit(lanes, component) once per distinct component among the lanes of `which`, with its
/// lanes and its index as a scalar.
template <typename Visit>
HWY_INLINE void forEachComponent(LaneMask which, Int components, Visit&& visit) {
  const LaneArray<std::int32_t> each(components);
  for (LaneMask left = which; left.any();) {
    const std::int32_t first = each[static_cast<std::size_t>(std::countr_zero(left.bits()))];
    const LaneMask same = left & (components == first);
    visit(same, static_cast<std::size_t>(first));
    left = left.without(same);
  }
}

/// Label weights at one point per lane (LabelWeights::forEachWeight).
class LaneLabelWeights {
public:
  /// `index`: in the volume's index space.
  HWY_INLINE LaneLabelWeights(const SimdLabelWeights& weights, const Float3& index)
      : m_weights(weights), m_corner(findCorner(mapPoint(weights.toWeights, index))) {}

  /// Calls visit(lanes, components, fractions) until all weights of the lanes of `which` have been
  /// visited. `lanes` are those with a fraction above 0; it is 0 in the others.
  template <typename Visit>
  HWY_INLINE void forEach(LaneMask which, Visit&& visit) const {
    const Int code = gather(m_weights.bricks, m_corner.brick);
    const LaneMask mixed = which & (code < 0);
    Int components = code;
    Float fraction = zeroUnless(which, 1.0F);
    LaneMask some = which;
    if (mixed.any()) {
      const Remainder rest = forEachPlane(mixed, code ^ -1 /* ~code */, visit);
      components.setIf(mixed, rest.components);
      fraction.setIf(mixed, interpolateFraction(rest.bytes));
      some = fraction > 0.0F;
    }
    if (some.any())
      visit(some, components, fraction);
  }

private:
  /// The lowest of the eight voxels around a point.
  struct Corner {
    Int brick, voxel; ///< index of the brick; of the voxel within it
    Float3 fractions; ///< distance from the voxel, 0 to 1
  };
  static constexpr std::int32_t edge = LabelWeights::brickEdge + 1; ///< voxels
  /// Weights of a plane, four bytes per element: bytes 0 to 3 and 4 to 7 from the lowest voxel on,
  /// then the same in the next slice.
  using Bytes = std::array<Int, 4>;
  /// Component that gets the rest in a mixed brick, and its weights: 255 minus those of all planes.
  struct Remainder {
    Int components;
    Bytes bytes;
  };

  HWY_INLINE Corner findCorner(const Float3& p) const {
    const SimdAxes& axes = m_weights.axes;
    const AxisPosition x = locateOnAxis(axes[0], p.x);
    const AxisPosition y = locateOnAxis(axes[1], p.y);
    const AxisPosition z = locateOnAxis(axes[2], p.z);
    const auto toBrick = [](Float cell) { return floor(cell * (1.0F / LabelWeights::brickEdge)); };
    const Float3 cell{x.lower, y.lower, z.lower};
    const Float3 brick{toBrick(cell.x), toBrick(cell.y), toBrick(cell.z)};
    const Float3 inside = cell - float{LabelWeights::brickEdge} * brick;
    const Float voxel = fma(fma(inside.z, float{edge}, inside.y), float{edge}, inside.x);
    return {voxelOffset(axes, brick.x, brick.y, brick.z),
            nonNegativeToInt(voxel),
            {x.fraction, y.fraction, z.fraction}};
  }

  /// Visits the planes of mixed bricks and returns the remainder. `plane`: the brick's first.
  template <typename Visit>
  HWY_INLINE Remainder forEachPlane(LaneMask mixed, Int plane, Visit&& visit) const {
    constexpr std::int32_t byte = 8, tail = sizeof(LabelWeights::Plane) - sizeof(std::int32_t);
    static_assert(offsetof(LabelWeights::Plane, component) == tail + 1);
    const auto* const memory = reinterpret_cast<const std::uint8_t*>(m_weights.planes);
    Remainder rest{0, {-1, -1, -1, -1}};
    for (LaneMask left = mixed; left.any(); plane = plane + 1) {
      const Int start = zeroUnless(left, plane * std::int32_t{sizeof(LabelWeights::Plane)});
      // Bytes 1 to 3: component, rest, isLast.
      const Int numbers = loadInts(memory + tail, Indices(start));
      const Bytes bytes = loadBytes(memory, start + m_corner.voxel);
      for (std::size_t i = 0; i < bytes.size(); ++i)
        rest.bytes[i] = rest.bytes[i] - zeroUnless(left, bytes[i]); // no borrow: sums are <= 255
      rest.components.setIf(left, shiftRight<2 * byte>(numbers) & 0xff);
      const Float fraction = zeroUnless(left, interpolateFraction(bytes));
      if (const LaneMask some = fraction > 0.0F; some.any())
        visit(some, shiftRight<byte>(numbers) & 0xff, fraction);
      left = left & (numbers < 1 << 3 * byte); // isLast is 0
    }
    return rest;
  }

  static HWY_INLINE Bytes loadBytes(const std::uint8_t* memory, Int first) {
    const Indices index(first);
    const Pairs low = loadPairs(memory, index), high = loadPairs(memory + edge * edge, index);
    return {bitsAsInt(low.first), bitsAsInt(low.second), bitsAsInt(high.first),
            bitsAsInt(high.second)};
  }

  /// Fraction, trilinear between the eight voxels around the point.
  HWY_INLINE Float interpolateFraction(const Bytes& bytes) const {
    static_assert(edge == 5); // the next row starts one byte after the first four
    const Float3& f = m_corner.fractions;
    const auto slice = [&](std::size_t i) {
      const Int row = bytes[i], next = bytes[i + 1];
      return interpolate(toFloat(row & 0xff), toFloat(shiftRight<8>(row) & 0xff),
                         toFloat(shiftRight<8>(next) & 0xff), toFloat(shiftRight<16>(next) & 0xff),
                         f.x, f.y);
    };
    return lerp(slice(0), slice(2), f.z) * (1.0F / 255.0F);
  }

  const SimdLabelWeights& m_weights;
  Corner m_corner;
};
