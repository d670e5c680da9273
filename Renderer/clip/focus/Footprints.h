#pragma once
// Which samples of a depth buffer can meet something at all: found from its projection, so that no
// ray is traced for the others.

#include "clip/focus/DepthBuffer.h"
#include "clip/focus/FocusCells.h"
#include "model/volume/Domain.h"

#include <vector>

namespace fenestra {

/// For each row of a depth buffer, samples outside of which no ray meets a volume's domain.
class DomainFootprint {
public:
  DomainFootprint(const Camera& camera, const Domain& domain);

  /// Between two columns, the second excluded, lie all samples of the row that meet the domain:
  /// those and a few more, or every one where the domain reaches behind the eye.
  struct Columns {
    std::int64_t first, end;
  };
  Columns columns(const DepthBuffer& buffer, std::int64_t row) const;

private:
  std::vector<Vec2> m_corners; ///< on the plane through the target, mm
  bool m_isInFront = true;     ///< all of it; else the projection has no bounds
};

/// For each tile of samples the range of depths in which their rays can meet the focus.
class FocusFootprint {
public:
  FocusFootprint(const Camera& camera, const DepthBuffer& buffer, const FocusCells& cells);

  /// mm; empty where no block of the focus is seen.
  Interval depths(std::int64_t column, std::int64_t row) const {
    return m_tiles[static_cast<std::size_t>(column / tileSize + row / tileSize * m_across)];
  }

private:
  static constexpr std::int64_t tileSize = 4; ///< samples

  std::int64_t m_across; ///< tiles in a row
  std::vector<Interval> m_tiles;
};

/// A rectangle of cells between samples, each told by its first sample; right and bottom are
/// excluded.
struct CellRange {
  std::int64_t left, right, top, bottom;

  std::int64_t columns() const { return right - left; }
  std::int64_t rows() const { return bottom - top; }
  std::size_t size() const { return static_cast<std::size_t>(columns() * rows()); }
  /// A cell's place, row by row.
  std::size_t at(std::int64_t column, std::int64_t row) const {
    return static_cast<std::size_t>(column - left + columns() * (row - top));
  }
};

/// A rectangle that holds all cells whose rays can meet the focus or pass a summit of it
/// (FocusCells).
CellRange focusRange(const Camera& camera, const DepthBuffer& buffer, const FocusCells& cells);

/// For each cell of a range the depths, mm, between which its rays can meet the focus or pass a
/// summit of it; empty where they can not, and in cells that are not asked for.
std::vector<Interval> focusReaches(const Camera& camera, const DepthBuffer& buffer,
                                   const FocusCells& cells, const CellRange& range,
                                   const std::vector<std::uint8_t>& isAskedFor);

} // namespace fenestra
