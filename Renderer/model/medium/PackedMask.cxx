#include "model/medium/PackedMask.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <span>

namespace fenestra::core {
namespace {

constexpr std::ptrdiff_t maxRun = 128; ///< maximum length of a run or of a literal stretch
constexpr std::ptrdiff_t minRun = 3;   ///< minimum number of equal voxels for a run

using Row = std::span<const std::uint8_t>;

/// Number of leading voxels that equal the first one.
std::ptrdiff_t countEqual(Row row) {
  const auto other = std::ranges::find_if(row, [&](std::uint8_t v) { return v != row.front(); });
  return other - row.begin();
}

/// Appends the encoded row (PackedMask::Slice).
void packRow(Row row, std::vector<std::uint8_t>& bytes) {
  const auto addByte = [&bytes](std::ptrdiff_t value) {
    bytes.push_back(static_cast<std::uint8_t>(value));
  };
  while (!row.empty()) {
    std::ptrdiff_t count = std::min(countEqual(row), maxRun);
    if (count >= minRun) {
      addByte(127 + count);
      bytes.push_back(row.front());
    } else {
      const auto left = std::min(std::ssize(row), maxRun);
      while (count < left) {
        const std::ptrdiff_t equal = countEqual(row.subspan(static_cast<std::size_t>(count)));
        if (equal >= minRun)
          break;
        count = std::min(count + equal, left);
      }
      addByte(count - 1);
      bytes.insert(bytes.end(), row.begin(), row.begin() + count);
    }
    row = row.subspan(static_cast<std::size_t>(count));
  }
}

} // namespace

PackedMask::PackedMask(const Mask& mask)
    : m_grid(mask.grid),
      m_maxValue(mask.maxValue),
      m_slices(static_cast<std::size_t>(m_grid.size.z())) {
  const auto columns = static_cast<std::size_t>(m_grid.size.x());
  const auto rows = static_cast<std::size_t>(m_grid.size.y());
  tbb::parallel_for(std::size_t{0}, m_slices.size(), [&](std::size_t z) {
    Slice& slice = m_slices[z];
    slice.rowStart.push_back(0);
    for (std::size_t y = 0; y < rows; ++y) {
      const Row row(mask.voxels.data() + columns * (y + rows * z), columns);
      if (row.front() != 0 || countEqual(row) < std::ssize(row))
        packRow(row, slice.bytes);
      slice.rowStart.push_back(slice.bytes.size());
    }
    slice.bytes.shrink_to_fit();
  });
}

bool PackedMask::unpackRow(std::int64_t y, std::int64_t z, std::uint8_t* to) const {
  const Slice& slice = m_slices[static_cast<std::size_t>(z)];
  const auto row = static_cast<std::size_t>(y);
  const std::uint8_t* from = slice.bytes.data() + slice.rowStart[row];
  const std::uint8_t* const end = slice.bytes.data() + slice.rowStart[row + 1];
  if (from == end)
    return false;
  while (from != end) {
    const int number = *from++;
    if (number < maxRun) {
      to = std::copy_n(from, number + 1, to);
      from += number + 1;
    } else {
      to = std::fill_n(to, number - 127, *from++);
    }
  }
  return true;
}

} // namespace fenestra::core
