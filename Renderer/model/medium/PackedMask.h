#pragma once
// A mask with run-length encoded rows (as in PackBits). Smoothed masks of a segmentation shrink to
// a tenth or less, so that many fit into memory at once.

#include "model/volume/Mask.h"

#include <cstdint>
#include <vector>

namespace fenestra::core {

class PackedMask {
public:
  explicit PackedMask(const Mask& mask);

  const Grid& grid() const { return m_grid; }
  std::uint8_t maxValue() const { return m_maxValue; } ///< Mask::maxValue
  /// Writes the size.x() voxels of a row to `to`. Returns false, and writes nothing, if all are 0.
  bool unpackRow(std::int64_t y, std::int64_t z, std::uint8_t* to) const;

private:
  /// Encoded rows: a byte n < 128 precedes n + 1 literal voxels; n >= 128 precedes one voxel that
  /// is repeated n - 127 times. A row of zeros is empty.
  struct Slice {
    std::vector<std::size_t> rowStart; ///< in `bytes`; the last entry is the end
    std::vector<std::uint8_t> bytes;
  };

  Grid m_grid;
  std::uint8_t m_maxValue;
  std::vector<Slice> m_slices;
};

} // namespace fenestra::core
