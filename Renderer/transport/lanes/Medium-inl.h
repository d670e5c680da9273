// Look-ups of lanes at points in index space: scalar, extinction, majorant cells. Compiled once for
// each instruction set (see Tracker.cxx).

#if defined(FENESTRA_WIDE_LOOKUP_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef FENESTRA_WIDE_LOOKUP_INL_H
#undef FENESTRA_WIDE_LOOKUP_INL_H
#else
#define FENESTRA_WIDE_LOOKUP_INL_H
#endif

#include "transport/lanes/TrackerTables.h"
// After foreach_target.h:
#include "base/Lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace fenestra::HWY_NAMESPACE {

/// Indices of lanes, stored in memory.
struct alignas(64) Indices : std::array<std::int32_t, HWY_MAX_BYTES / sizeof(std::int32_t)> {
  explicit HWY_INLINE Indices(I index) { hn::Store(index, ints, data()); }
};

/// Loads a Number from each of `count` places, aligned or not. Loads one by one are less work for
/// the processor than gathers, once the indices are in memory.
template <typename Number, std::size_t count, typename Element>
HWY_INLINE auto loadEach(const Element* memory, const std::int32_t* index) {
  constexpr hn::CappedTag<Number, count> d;
  if constexpr (count == 1)
    return hn::LoadU(d, reinterpret_cast<const Number*>(memory + *index));
#if HWY_TARGET != HWY_SCALAR
  else
    return hn::Combine(d, loadEach<Number, count / 2>(memory, index + count / 2),
                       loadEach<Number, count / 2>(memory, index));
#endif
}

/// Loads 32 bits from memory[i] on for each i.
template <typename Element>
HWY_INLINE I loadInts(const Element* memory, const Indices& index) {
  return loadEach<std::int32_t, hn::MaxLanes(ints)>(memory, index.data());
}

/// Two floats a lane, neighbours in memory.
struct Pairs {
  F first, second;
};

/// Loads memory[i] and memory[i + 1] for each i.
HWY_INLINE Pairs loadPairs(const float* memory, const Indices& index) {
#if HWY_TARGET == HWY_SCALAR
  return {hn::Set(floats, memory[index[0]]), hn::Set(floats, memory[index[0] + 1])};
#else
  constexpr std::size_t half = hn::MaxLanes(floats) / 2;
  const F low = hn::BitCast(floats, loadEach<std::int64_t, half>(memory, index.data()));
  const F high = hn::BitCast(floats, loadEach<std::int64_t, half>(memory, index.data() + half));
  return {hn::ConcatEven(floats, high, low), hn::ConcatOdd(floats, high, low)};
#endif
}

/// The eight voxels around a point: four rows of two along x.
using Corners = std::array<Pairs, 4>;

/// Offset of each row from the first row, in voxels.
HWY_INLINE std::array<std::int32_t, 4> rowsOf(const WideField& field) {
  const std::int32_t up = field.axes[1].stride;
  const std::int32_t deep = field.axes[2].stride;
  return {0, up, deep, deep + up};
}

HWY_INLINE Corners cornersAt(const WideField& field, const float* voxels, I first) {
  Corners c;
  const std::array<std::int32_t, 4> rows = rowsOf(field);
  const Indices index(first);
  for (std::size_t i = 0; i < rows.size(); ++i)
    c[i] = loadPairs(voxels + rows[i], index);
  return c;
}

/// Corners of 16-bit voxels: 32 bits hold a row's two voxels, extracted by `lower` and `upper`.
template <typename Voxel, typename Lower, typename Upper>
HWY_INLINE Corners cornersInPairs(const WideField& field, const Voxel* voxels, I first,
                                  Lower&& lower, Upper&& upper) {
  Corners c;
  const std::array<std::int32_t, 4> rows = rowsOf(field);
  const Indices index(first);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const I both = loadInts(voxels + rows[i], index);
    c[i] = {hn::ConvertTo(floats, lower(both)), hn::ConvertTo(floats, upper(both))};
  }
  return c;
}
HWY_INLINE Corners cornersAt(const WideField& field, const std::int16_t* voxels, I first) {
  return cornersInPairs(
      field, voxels, first, [](I both) { return hn::ShiftRight<16>(hn::ShiftLeft<16>(both)); },
      [](I both) { return hn::ShiftRight<16>(both); });
}
HWY_INLINE Corners cornersAt(const WideField& field, const std::uint16_t* voxels, I first) {
  const I low = hn::Set(ints, 0xffff);
  return cornersInPairs(
      field, voxels, first, [&](I both) { return hn::And(both, low); },
      [&](I both) { return hn::And(hn::ShiftRight<16>(both), low); });
}
HWY_INLINE Corners cornersAt(const WideField& field, const std::uint8_t* voxels, I first) {
  Corners c;
  const std::array<std::int32_t, 4> rows = rowsOf(field);
  const I low = hn::Set(ints, 0xff);
  const I lastFour = hn::Set(ints, static_cast<std::int32_t>(field.count - 4));
  for (std::size_t i = 0; i < rows.size(); ++i) {
    // Reads four bytes, never beyond the last voxel.
    const I row = hn::Add(first, hn::Set(ints, rows[i]));
    const I from = hn::Min(row, lastFour);
    const I shift = hn::ShiftLeft<3>(hn::Sub(row, from));
    const I four = loadInts(voxels, Indices(from));
    const I both = hn::Shr(four, shift);
    c[i] = {hn::ConvertTo(floats, hn::And(both, low)),
            hn::ConvertTo(floats, hn::And(hn::ShiftRight<8>(both), low))};
  }
  return c;
}

/// A point among voxel centres, clamped in the outer half voxel.
struct Place {
  I first;      ///< index of the lowest of the eight voxels around it
  F3 fractions; ///< position from there, 0 to 1
};

HWY_INLINE Place placeOf(const WideField& field, const Point& p) {
  const auto cell = [&](std::size_t axis, F x, F& fraction) {
    const WideField::Axis& a = field.axes[axis];
    // This order of min and max maps NaN to 0.
    const F inside = hn::Max(hn::Min(x, all(a.last)), hn::Zero(floats));
    const I index = hn::Min(hn::ConvertTo(ints, inside), hn::Set(ints, a.lastCell));
    fraction = hn::Sub(inside, hn::ConvertTo(floats, index));
    return index;
  };
  Place place;
  const I x = cell(0, p.x, place.fractions.x);
  const I y = cell(1, p.y, place.fractions.y);
  const I z = cell(2, p.z, place.fractions.z);
  place.first = hn::Add(x, hn::Add(hn::Mul(y, hn::Set(ints, field.axes[1].stride)),
                                   hn::Mul(z, hn::Set(ints, field.axes[2].stride))));
  return place;
}

/// Prefetches the voxels around the places of all lanes.
template <typename Voxel>
HWY_INLINE void prefetch(const WideField& field, const Place& place) {
  const auto* voxels = static_cast<const Voxel*>(field.voxels);
  const Indices first(place.first);
  const std::array<std::int32_t, 4> rows = rowsOf(field);
  for (std::size_t lane = 0; lane < hn::Lanes(floats); ++lane)
    for (const std::int32_t row : rows)
      hwy::Prefetch(voxels + first[lane] + row);
}

/// The scalar, trilinear between voxel centres.
template <typename Voxel>
HWY_INLINE F scalarAt(const WideField& field, const Place& place) {
  const Corners c = cornersAt(field, static_cast<const Voxel*>(field.voxels), place.first);
  const F3& f = place.fractions;
  const auto along = [&](const Pairs& row) { return lerp(row.first, row.second, f.x); };
  const F low = lerp(along(c[0]), along(c[1]), f.y);
  const F high = lerp(along(c[2]), along(c[3]), f.y);
  return lerp(low, high, f.z);
}
template <typename Voxel>
HWY_INLINE F scalarAt(const WideField& field, const Point& p) {
  return scalarAt<Voxel>(field, placeOf(field, p));
}

/// Segment of a table that holds a scalar.
struct Segment {
  I index;
  F beyondStart; ///< scalar units from the segment's start; not finite in the first segment
};

HWY_INLINE Segment segmentOf(const WideTable& table, F s) {
  s = hn::Min(s, all(std::numeric_limits<float>::max())); // interpolation can overflow
  const auto lastBin = static_cast<float>(table.binSegment.size() - 1);
  const F bin = hn::Mul(hn::Sub(s, all(table.binStart)), all(table.binsPerUnit));
  const I inTable = hn::ConvertTo(ints, hn::Max(hn::Min(bin, all(lastBin)), hn::Zero(floats)));
  I segment = hn::GatherIndex(ints, table.binSegment.data(), inTable);
  for (;;) {
    const Pairs ends = loadPairs(table.position.data(), Indices(segment));
    const M beyond = hn::Ge(s, ends.second);
    if (hn::AllFalse(floats, beyond))
      return {segment, hn::Sub(s, ends.first)};
    segment =
        hn::IfThenElse(hn::RebindMask(ints, beyond), hn::Add(segment, hn::Set(ints, 1)), segment);
  }
}

/// Value of a channel in a segment, clamped to >= 0.
HWY_INLINE F valueIn(const WideTable::Channel& channel, const Segment& at) {
  const auto [value, slope] = loadPairs(&channel[0].value, Indices(hn::ShiftLeft<1>(at.index)));
  // Constant segments may begin at -infinity.
  const F rise =
      hn::IfThenZeroElse(hn::Eq(slope, hn::Zero(floats)), hn::Mul(at.beyondStart, slope));
  return notBelow0(hn::Add(value, rise));
}

/// Extinction (mm^-1) of a scalar.
HWY_INLINE F extinctionOf(const WideScene& scene, F s) {
  return valueIn(scene.extinction.channels[0], segmentOf(scene.extinction, s));
}

/// Majorant cells, one a lane (WideCells::cell).
struct LaneCells {
  I code;     ///< in the upper half
  F majorant; ///< mm^-1
  F reach;    ///< cells

  HWY_INLINE M cut() const {
    return hn::RebindMask(floats, hn::TestBit(code, hn::Set(ints, 0x10000)));
  }
};

/// Cells of these numbers along the axes, whole and inside the grid.
HWY_INLINE LaneCells cellsAt(const WideScene& scene, F x, F y, F z) {
  // Fewer than 2^24 cells: exact.
  const F place =
      hn::MulAdd(z, all(scene.axes[2].cellStride),
                 hn::MulAdd(y, all(scene.axes[1].cellStride), hn::Add(x, all(scene.firstCell))));
  const Indices index(hn::ConvertTo(ints, place));
  LaneCells cells;
  cells.code = hn::ShiftLeft<16>(loadInts(scene.cells.codes.data(), index));
  const auto filled = hn::Gt(cells.code, hn::Zero(ints));
  constexpr int toMajorant = 16 + WideCells::reachBits + 1 - WideCells::majorantShift;
  const I majorant = hn::Add(hn::And(hn::ShiftRight<toMajorant>(cells.code),
                                     hn::Set(ints, 0x7ff << WideCells::majorantShift)),
                             hn::Set(ints, static_cast<std::int32_t>(scene.cells.bias)));
  cells.majorant = hn::BitCast(floats, hn::IfThenElseZero(filled, majorant));
  const I reach = hn::And(hn::ShiftRight<17>(cells.code), hn::Set(ints, WideCells::mostReach));
  cells.reach = hn::IfThenElse(hn::RebindMask(floats, filled), hn::ConvertTo(floats, reach),
                               hn::Neg(hn::BitCast(floats, cells.code)));
  return cells;
}

/// Length of a ray from inside [lower, upper] to the faces; 0 if rounding put the origin outside.
HWY_INLINE F toFaces(const F3& lower, const F3& upper, const F3& origin, const F3& direction) {
  const auto along = [](F low, F high, F o, F d) {
    const F zero = hn::Zero(floats);
    const F face = hn::IfThenElse(hn::Lt(d, zero), low, high);
    const F t = hn::Div(hn::Sub(face, o), d);
    return hn::IfThenElse(hn::Eq(d, zero), all(std::numeric_limits<float>::infinity()), t);
  };
  const F x = along(lower.x, upper.x, origin.x, direction.x);
  const F y = along(lower.y, upper.y, origin.y, direction.y);
  const F z = along(lower.z, upper.z, origin.z, direction.z);
  return notBelow0(hn::Min(hn::Min(x, y), z));
}

/// Length (mm) of a ray from inside the domain to its end; ray in index space, t in mm.
HWY_INLINE F lengthInside(const WideScene& scene, const F3& origin, const F3& direction) {
  const F toBox = toFaces(all3(scene.lower), all3(scene.upper), origin, direction);
  if (!scene.cropped)
    return toBox;
  const F one = all(1.0F);
  const F minusOne = all(-1.0F);
  const F toCrop = toFaces({minusOne, minusOne, minusOne}, {one, one, one},
                           mapPoint(scene.toCrop, origin), mapDirection(scene.toCrop, direction));
  return hn::Min(toBox, toCrop);
}

/// Lanes whose point (index space) lies in the focus, where a style changes nothing.
HWY_INLINE M isFocus(const WideScene::Context& context, const Point& p) {
  return hn::Ge(scalarAt<std::uint8_t>(context.focus, mapPoint(context.toFocus, p)),
                all(context.level));
}

} // namespace fenestra::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
