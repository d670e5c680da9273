#include "model/masks/CellLines.h"

#include "base/SimdTargets.h"

#include <bit>
#include <cstring>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "model/masks/CellLines.cxx"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
// After foreach_target.h:
#include "base/Simd-inl.h"

#ifndef FENESTRA_CELL_BATCH
#define FENESTRA_CELL_BATCH
namespace fenestra::core {

/// Voxels of cells that need lines, from four rows: words of eight voxels with up to seven cells.
struct CellBatch {
  static constexpr std::size_t word = 8, capacity = 32 * word;
  static constexpr std::size_t padding = 64; ///< for loads beyond the end

  std::array<std::array<std::int32_t, capacity + padding>, 4> rows;
  std::array<std::int32_t, capacity + padding> isCell; ///< between a voxel and the next: 1 or 0
  std::size_t count = 0;                               ///< of voxels
};

} // namespace fenestra::core
#endif

HWY_BEFORE_NAMESPACE();
namespace fenestra::core::HWY_NAMESPACE {
namespace {

/// The four values across the axis of greatest change, at one end of the lines.
struct CellFace {
  Int corner, next, other, opposite;
};

HWY_INLINE CellFace interpolate(const CellFace& face) {
  constexpr double nearer = 0.7886751345948129;               // Gauss, 2 points
  constexpr int bits = 16, one = LevelLengths::steps << bits; // fixed point
  constexpr int nearNear = static_cast<int>(nearer * nearer * one + 0.5),
                nearFar = static_cast<int>(nearer * (1.0 - nearer) * one + 0.5),
                farFar = one - nearNear - 2 * nearFar;
  const auto at = [](Int same, Int sides, Int far) {
    return shiftRight<bits>(Int(nearNear) * same + Int(nearFar) * sides + Int(farFar) * far +
                            Int(1 << (bits - 1)));
  };
  const Int diagonal = face.corner + face.opposite, sides = face.next + face.other;
  return {at(face.corner, sides, face.opposite), at(face.next, diagonal, face.other),
          at(face.other, diagonal, face.next), at(face.opposite, sides, face.corner)};
}

/// Adds lines between two values in the lanes of `cells`. Returns the length that lines inside at
/// all of `levels` lack, since their densities are rounded down.
HWY_INLINE Int addLines(Int a, Int b, LaneMask cells, const std::int32_t* remainders,
                        LevelLengths& lengths, std::int64_t& inside) {
  constexpr int steps = LevelLengths::steps, most = LevelLengths::maxValue;
  const LevelLengths::Levels& levels = lengths.levels();
  const LaneMask isConstant = a == b;
  Int begin = min(a, b), end = max(a, b);
  begin.setIf(isConstant & (begin < Int(most)), max(begin - Int(steps), Int(0)));
  end.setIf(isConstant & (end > Int(0)), min(end + Int(steps), Int(most)));
  const LaneMask isInside = cells & (begin > Int(levels.last - 1));
  inside += static_cast<std::int64_t>(isInside.count());
  const LaneMask isOn = (cells & (end > Int(levels.first))).without(isInside);
  if (isOn.any()) {
    std::array<std::int32_t, laneCount> begins, ends;
    hn::StoreU(begin.v, ints, begins.data());
    hn::StoreU(end.v, ints, ends.data());
    for (std::uint64_t left = isOn.bits(); left != 0; left &= left - 1) {
      const auto lane = static_cast<std::size_t>(std::countr_zero(left));
      lengths.addLine(begins[lane], ends[lane]);
    }
  }
  return zeroUnless(isInside,
                    Int(hn::GatherIndex(ints, remainders, zeroUnless(isInside, end - begin).v)));
}

void addBatch(const CellBatch& batch, const std::int32_t* remainders, LevelLengths& lengths) {
  Int lacking(0);
  std::int64_t inside = 0;
  for (std::size_t i = 0; i < batch.count; i += laneCount) {
    const auto read = [&](std::size_t row, std::size_t x) {
      return Int(hn::LoadU(ints, batch.rows[row].data() + i + x));
    };
    const LaneMask cells = Int(hn::LoadU(ints, batch.isCell.data() + i)) > Int(0);
    const std::array<Int, 8> cell = {read(0, 0), read(0, 1), read(1, 0), read(1, 1),
                                     read(2, 0), read(2, 1), read(3, 0), read(3, 1)};
    const auto abs = [](Int value) { return max(value, -value); };
    const Int changeX = abs(cell[1] - cell[0] + cell[3] - cell[2] + cell[5] - cell[4] + cell[7] -
                            cell[6]),
              changeY = abs(cell[2] - cell[0] + cell[3] - cell[1] + cell[6] - cell[4] + cell[7] -
                            cell[5]),
              changeZ = abs(cell[4] - cell[0] + cell[5] - cell[1] + cell[6] - cell[2] + cell[7] -
                            cell[3]);
    const LaneMask isZ = changeZ > max(changeX, changeY), isY = changeY > changeX;
    const auto choose = [&](std::size_t x, std::size_t y, std::size_t z) {
      return select(isZ, cell[z], select(isY, cell[y], cell[x]));
    };
    const CellFace a = interpolate({cell[0], choose(2, 4, 1), choose(4, 1, 2), choose(6, 5, 3)});
    const CellFace b = interpolate({choose(1, 2, 4), choose(3, 6, 5), choose(5, 3, 6), cell[7]});
    lacking = lacking + addLines(a.corner, b.corner, cells, remainders, lengths, inside) +
              addLines(a.next, b.next, cells, remainders, lengths, inside) +
              addLines(a.other, b.other, cells, remainders, lengths, inside) +
              addLines(a.opposite, b.opposite, cells, remainders, lengths, inside);
  }
  lengths.addInside(inside * LevelLengths::unit -
                    static_cast<std::int64_t>(hn::GetLane(hn::SumOfLanes(ints, lacking.v))));
}

} // namespace
} // namespace fenestra::core::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace fenestra::core {

HWY_EXPORT(addBatch);

namespace {

/// What the densities of a line over 0, 1, 2, ... steps lack to its length.
const std::int32_t* findRemainders() {
  using Remainders = std::array<std::int32_t, LevelLengths::maxValue + 1>;
  static const Remainders all = [] {
    Remainders result{};
    for (std::size_t length = 1; length < result.size(); ++length)
      result[length] =
          static_cast<std::int32_t>(LevelLengths::unit % static_cast<std::int64_t>(length));
    return result;
  }();
  return all.data();
}

/// Tests words of eight voxels for values that are too low to reach a range of levels.
class LowTest {
public:
  LowTest(const VoxelValues& values, const LevelLengths::Levels& levels) {
    std::uint64_t low = 0; // greatest voxel value, up to 127, that is too low
    while (low < 127 &&
           LevelLengths::steps * (static_cast<int>(values[low + 1]) + 1) <= levels.first)
      ++low;
    m_toHighBit = (127 - low) * ones;
  }

  /// Bits of voxels that may reach the levels; other bits are 0. 0 is always too low.
  std::uint64_t findOthers(std::uint64_t word) const {
    return (((word & lowBits) + m_toHighBit) | word) & ~lowBits;
  }

private:
  static constexpr std::uint64_t ones = 0x0101010101010101, lowBits = 0x7f * ones;
  std::uint64_t m_toHighBit;
};

} // namespace

void addCellLines(const std::array<const std::uint8_t*, 4>& rows, std::int64_t count,
                  const VoxelValues& values, LevelLengths& lengths) {
  constexpr auto word = static_cast<std::int64_t>(CellBatch::word);
  const LowTest lowTest(values, lengths.levels());
  CellBatch batch;
  const auto flush = [&] {
    std::fill_n(batch.isCell.begin() + static_cast<std::ptrdiff_t>(batch.count), CellBatch::padding,
                0);
    HWY_DYNAMIC_DISPATCH(addBatch)(batch, findRemainders(), lengths);
    batch.count = 0;
  };
  const auto addWord = [&](std::int64_t x, std::int64_t voxels) {
    for (std::size_t r = 0; r < 4; ++r)
      for (std::int64_t i = 0; i < voxels; ++i)
        batch.rows[r][batch.count + static_cast<std::size_t>(i)] = values[rows[r][x + i]];
    for (std::int64_t i = 0; i < word; ++i)
      batch.isCell[batch.count + static_cast<std::size_t>(i)] = i + 1 < voxels;
    batch.count += CellBatch::word;
    if (batch.count == CellBatch::capacity)
      flush();
  };
  std::int64_t x = 0, alwaysInside = 0;
  for (; x + word <= count; x += word - 1) {
    std::uint64_t some = 0, all = ~some;
    for (const std::uint8_t* const row : rows) {
      std::uint64_t eight;
      std::memcpy(&eight, row + x, sizeof eight);
      some |= lowTest.findOthers(eight);
      all &= eight;
    }
    if (all == ~std::uint64_t{0})
      alwaysInside += 4 * (word - 1);
    else if (some != 0)
      addWord(x, word);
  }
  if (x + 1 < count)
    addWord(x, count - x);
  lengths.addInside(alwaysInside * LevelLengths::unit);
  if (batch.count > 0)
    flush();
}

} // namespace fenestra::core
#endif
