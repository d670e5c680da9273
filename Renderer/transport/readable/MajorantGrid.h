#pragma once
// An upper bound of the extinction in each cell of a coarse grid: what null-collision tracking
// steps by. Cells that hold nothing, or nothing that clipping keeps, have majorant 0 and are
// skipped.

#include "clip/keep/Clip.h"
#include "model/medium/ContextStyle.h"
#include "model/medium/TransferFunction.h"
#include "model/volume/CellRanges.h"

namespace fenestra {

class MajorantGrid {
public:
  struct Cell {
    float majorant; ///< mm^-1
    bool cut;       ///< clipping may remove part of it: ask keep
  };

  /// The majorant is the transfer function's greatest value over the cell's whole range of scalars
  /// (not at its maximum: opacity need not grow with the scalar), times the greatest gradient
  /// opacity that the range allows, times the most that the clip and a style leave in the cell.
  /// `ranges` needs the apron that apronFor() says.
  MajorantGrid(const Grid& grid, const CellRanges& ranges, const TransferFunction& transfer,
               const Clip& clip, const ContextStyle* style = nullptr);

  /// Central differences read one voxel further.
  static int apronFor(const TransferFunction& transfer) { return transfer.gradientOpacity ? 1 : 0; }

  const Size3& cellCount() const { return m_cellCount; }
  std::size_t size() const { return m_cells.size(); }
  /// How many have majorant 0.
  std::size_t emptyCount() const;
  /// Voxels that a cell spans.
  const Size3& edge() const { return m_edge; }
  const Cell& cell(std::int64_t index) const { return m_cells[static_cast<std::size_t>(index)]; }
  /// World space to cell space, in which cell c covers [c, c + 1].
  const Affine& worldToCell() const { return m_worldToCell; }

private:
  Size3 m_cellCount, m_edge;
  Affine m_worldToCell;
  std::vector<Cell> m_cells;
};

} // namespace fenestra
