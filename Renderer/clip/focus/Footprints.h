#pragma once
// Samples of a depth buffer whose rays can meet a volume or a focus, found by projection: no ray is
// traced for the other samples.

#include "clip/focus/DepthBuffer.h"
#include "clip/focus/FocusCells.h"
#include "model/volume/Domain.h"

#include <vector>

namespace fenestra {

/// Per row of a depth buffer: columns outside of which no ray meets a volume's domain.
class DomainFootprint {
public:
  DomainFootprint(const Camera& camera, const Domain& domain);

  /// Columns [first, end): all samples of the row whose rays meet the domain, and a few more; the
  /// whole row if the domain reaches behind the eye.
  struct Columns {
    std::int64_t first, end;
  };
  Columns columns(const DepthBuffer& buffer, std::int64_t row) const;

private:
  std::vector<Vec2> m_corners; ///< on the plane through the target, mm
  bool m_isInFront = true;     ///< false: domain reaches behind the eye, unbounded projection
};

/// Per tile of samples: range of depths in which the tile's rays can meet the focus.
class FocusFootprint {
public:
  FocusFootprint(const Camera& camera, const DepthBuffer& buffer, const FocusCells& cells);

  /// Range for a sample's tile, mm; empty: no block of the focus is seen.
  Interval depths(std::int64_t column, std::int64_t row) const {
    return m_tiles[static_cast<std::size_t>(column / tileSize + row / tileSize * m_tilesPerRow)];
  }

private:
  static constexpr std::int64_t tileSize = 4; ///< samples

  std::int64_t m_tilesPerRow; ///< tiles in a row
  std::vector<Interval> m_tiles;
};

/// Rectangle of cells between samples, a cell being named by its first sample; right and bottom are
/// excluded.
struct CellRange {
  std::int64_t left, right, top, bottom;

  std::int64_t columns() const { return right - left; }
  std::int64_t rows() const { return bottom - top; }
  std::size_t size() const { return static_cast<std::size_t>(columns() * rows()); }
  /// Index of a cell, row by row.
  std::size_t at(std::int64_t column, std::int64_t row) const {
    return static_cast<std::size_t>(column - left + columns() * (row - top));
  }
};

/// Rectangle that holds all cells whose rays can meet the focus or have a summit (FocusCells).
CellRange findFocusRange(const Camera& camera, const DepthBuffer& buffer, const FocusCells& cells);

/// Per cell of `range`: depths, mm, between which the cell's rays can meet the focus or have a
/// summit; empty: none, or isRequested is 0.
std::vector<Interval> computeDepthBounds(const Camera& camera, const DepthBuffer& buffer,
                                         const FocusCells& cells, const CellRange& range,
                                         const std::vector<std::uint8_t>& isRequested);

} // namespace fenestra
