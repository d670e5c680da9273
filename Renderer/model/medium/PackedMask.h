#pragma once
// A mask whose rows are packed: a stretch of equal voxels is a number and a value. Smoothed masks
// of a segmentation take a tenth or less of their voxels, and many can be held at once.

#include "model/volume/Mask.h"

#include <cstdint>
#include <vector>

namespace fenestra {

class PackedMask {
public:
  explicit PackedMask(const Mask& mask);

  const Grid& grid() const { return m_grid; }
  std::uint8_t maxValue() const { return m_maxValue; } ///< Mask::full
  /// Writes the voxels of a row to `to`, size.x() of them; false: all are 0, and none is written.
  bool unpackRow(std::int64_t y, std::int64_t z, std::uint8_t* to) const;

private:
  /// Packed rows, one after the other: a byte n < 128 before n + 1 voxels, or n >= 128 before one
  /// that is repeated n - 127 times; nothing for a row of zeros.
  struct Slice {
    std::vector<std::size_t> rowStart; ///< in `bytes`, and their end
    std::vector<std::uint8_t> bytes;
  };

  Grid m_grid;
  std::uint8_t m_maxValue;
  std::vector<Slice> m_slices;
};

} // namespace fenestra
