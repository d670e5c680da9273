#pragma once
// An upper bound of the extinction in each cell of a coarse grid: what null-collision tracking
// steps by. Cells that hold nothing (or nothing that clipping keeps) have majorant 0 and are
// skipped.

#include "medium/TransferFunction.h"
#include "volume/CellRanges.h"

#include <functional>

namespace fenestra {

class MajorantGrid {
public:
  /// Says of a cell's eight world-space corners whether clipping removes all that lies within.
  using Removed = std::function<bool(const std::array<Vec3, 8>&)>;

  /// The majorant is the transfer function's greatest value over the cell's whole range of scalars
  /// (not at its maximum: opacity need not grow with the scalar), times the greatest gradient
  /// opacity that the range allows. `ranges` needs an apron of 1 where there is gradient opacity.
  MajorantGrid(const Grid& grid, const CellRanges& ranges, const TransferFunction& transfer,
               const Removed& removed);

  /// The apron that CellRanges needs for this transfer function.
  static int apronFor(const TransferFunction& transfer) { return transfer.gradientOpacity ? 1 : 0; }

  const Size3& cellCount() const { return m_cellCount; }
  double majorant(std::size_t cell) const { return m_majorants[cell]; }
  /// World space to cell space, in which cell c covers [c, c + 1].
  const Affine& worldToCell() const { return m_worldToCell; }
  /// Share of cells with majorant 0.
  double emptyFraction() const;

private:
  Size3 m_cellCount;
  Affine m_worldToCell;
  std::vector<double> m_majorants;
};

} // namespace fenestra
