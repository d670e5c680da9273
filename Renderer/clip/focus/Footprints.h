#pragma once
// Projects a volume or a focus onto a depth buffer, to trace rays only for samples that can hit it.

#include "clip/focus/DepthBuffer.h"
#include "clip/focus/FocusCells.h"
#include "model/volume/Domain.h"

#include <vector>

namespace fenestra::core {

/// Projection of a volume's domain: per row of a depth buffer, the columns whose rays can meet it.
class DomainFootprint {
public:
  DomainFootprint(const Camera& camera, const Domain& domain);

  /// Columns [first, end), conservative; all columns if the domain extends behind the camera.
  struct Columns {
    std::int64_t first, end;
  };
  Columns columns(const DepthBuffer& buffer, std::int64_t row) const;

private:
  std::vector<Vec2> m_corners; ///< on the plane through the target, mm
  bool m_isInFront = true;     ///< false: domain extends behind the camera, unbounded projection
};

/// Per tile of samples: the depths between which the tile's rays can hit the focus.
class FocusFootprint {
public:
  FocusFootprint(const Camera& camera, const DepthBuffer& buffer, const FocusCells& cells);

  /// Depths of a sample's tile, mm; empty if its rays miss all blocks of the focus.
  Interval depths(std::int64_t column, std::int64_t row) const {
    return m_tiles[static_cast<std::size_t>(column / tileSize + row / tileSize * m_tilesPerRow)];
  }

private:
  static constexpr std::int64_t tileSize = 4; ///< samples

  std::int64_t m_tilesPerRow;
  std::vector<Interval> m_tiles;
};

/// Rectangle of cells between samples. A cell has the column and row of its first sample; `right`
/// and `bottom` are exclusive.
struct CellRange {
  std::int64_t left, right, top, bottom;

  std::int64_t columns() const { return right - left; }
  std::int64_t rows() const { return bottom - top; }
  std::size_t size() const { return static_cast<std::size_t>(columns() * rows()); }
  /// Row-major index of a cell in the rectangle.
  std::size_t at(std::int64_t column, std::int64_t row) const {
    return static_cast<std::size_t>(column - left + columns() * (row - top));
  }
};

/// Bounds all cells whose rays can hit the focus or have a ray maximum (FocusCells).
CellRange findFocusRange(const Camera& camera, const DepthBuffer& buffer, const FocusCells& cells);

/// Per cell of `range`: depths, mm, between which its rays can hit the focus or have a ray maximum.
/// Empty if there are none, or if isRequested is 0.
std::vector<Interval> computeDepthBounds(const Camera& camera, const DepthBuffer& buffer,
                                         const FocusCells& cells, const CellRange& range,
                                         const std::vector<std::uint8_t>& isRequested);

} // namespace fenestra::core
