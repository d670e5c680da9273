#pragma once
// An upper bound of the extinction in each cell of a coarse grid, for null-collision tracking.
// Cells that are empty, or that clipping removes whole, have majorant 0 and are skipped.

#include "clip/field/Clip.h"
#include "model/medium/ContextStyle.h"
#include "model/medium/Mixture.h"
#include "model/medium/TransferFunction.h"
#include "model/volume/MinMaxGrid.h"

namespace fenestra {

class MajorantGrid {
public:
  struct Cell {
    float majorant; ///< mm^-1
    bool isCut;     ///< clipping may remove part of the cell: query keep
  };

  /// The majorant is the transfer function's greatest value over the cell's whole range of scalars
  /// (not at its maximum: opacity need not grow with the scalar), times the greatest gradient
  /// opacity that the range allows, times the greatest keep and the style's greatest factor in the
  /// cell. Of a mixture it is the greatest over the components that have a share in the cell, since
  /// shares sum to 1. `ranges` needs the apron of requiredPadding().
  MajorantGrid(const Grid& grid, const MinMaxGrid& ranges, const TransferFunction& transfer,
               const Clip& clip, const ContextStyle* style = nullptr,
               const Mixture* mixture = nullptr);

  /// Width, voxels, of the strip around a cell in which its bound holds, too: lanes may walk that
  /// far beyond a face. Scalars are bounded half a voxel beyond (MinMaxGrid).
  static constexpr double margin = 0.125;

  /// Apron of MinMaxGrid, voxels: central differences read one voxel further.
  static int requiredPadding(const TransferFunction& transfer) {
    return transfer.gradientOpacity ? 1 : 0;
  }

  const Size3& cellCount() const { return m_cellCount; }
  std::size_t size() const { return m_cells.size(); }
  /// Number of cells with majorant 0.
  std::size_t emptyCount() const;
  /// Box, in index space, of the cells with a majorant above 0; Box::nothing(): all are empty.
  Box occupiedBounds() const;
  /// Edges of a cell, voxels per axis.
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
