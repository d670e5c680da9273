#pragma once
// Upper bound of the extinction in each cell of a coarse grid, for null-collision tracking. Cells
// that are empty or removed by the clip have majorant 0, and trackers skip them.

#include "clip/field/Clip.h"
#include "model/medium/ContextStyle.h"
#include "model/medium/Mixture.h"
#include "model/medium/TransferFunction.h"
#include "model/volume/MinMaxGrid.h"

namespace fenestra::core {

class MajorantGrid {
public:
  struct Cell {
    float majorant; ///< mm^-1
    bool isCut;     ///< clip weight may be below 1 in the cell: evaluate it at each collision
  };

  /// The majorant is the product of three maxima over the cell: the transfer function over the
  /// cell's range of scalars (opacity need not grow with the scalar), the gradient opacity that
  /// this range allows, and clip weight times the style's factor. For a mixture it is the maximum
  /// over the components present in the cell, since label weights sum to 1. `ranges` must have the
  /// padding requiredPadding().
  MajorantGrid(const Grid& grid, const MinMaxGrid& ranges, const TransferFunction& transfer,
               const Clip& clip, const ContextStyle* style = nullptr,
               const Mixture* mixture = nullptr);

  /// The bound of a cell also holds this far outside it, in voxels: SIMD tracking steps up to half
  /// of it past a face. MinMaxGrid bounds scalars even half a voxel outside a cell.
  static constexpr double margin = 0.125;

  /// Padding that MinMaxGrid needs, voxels: central differences read one voxel further.
  static int requiredPadding(const TransferFunction& transfer) {
    return transfer.gradientOpacity ? 1 : 0;
  }

  const Size3& cellCount() const { return m_cellCount; }
  std::size_t size() const { return m_cells.size(); }
  /// Number of cells with majorant 0.
  std::size_t emptyCount() const;
  /// Bounding box, in index space, of the cells with a majorant above 0; empty if there are none.
  Box occupiedBounds() const;
  /// Size of a cell, voxels per axis.
  const Size3& edge() const { return m_edge; }
  const Cell& cell(std::int64_t index) const { return m_cells[static_cast<std::size_t>(index)]; }
  /// World space to cell space, in which cell c covers [c, c + 1].
  const Affine& worldToCell() const { return m_worldToCell; }

private:
  Size3 m_cellCount, m_edge;
  Affine m_worldToCell;
  std::vector<Cell> m_cells;
};

} // namespace fenestra::core
