#pragma once
// Upper bound of the extinction in each cell of a coarse grid, for null-collision tracking. Cells
// that are empty or removed by the clip have majorant 0, and trackers skip them.

#include "clip/field/Clip.h"
#include "model/medium/ContextStyle.h"
#include "model/medium/Mixture.h"
#include "model/medium/TransferFunction.h"
#include "model/volume/MinMaxGrid.h"

namespace fenestra::core {

/// Upper bounds of the extinction in the cells of a grid, before clip and style: what does not
/// depend on the camera.
class ExtinctionBounds {
public:
  /// The bound of a cell is the product of two maxima over it: the transfer function over the
  /// cell's range of scalars (opacity need not grow with the scalar), and the gradient opacity that
  /// this range allows. For a mixture it is the maximum over the components present in the cell,
  /// since label weights sum to 1. `ranges` must have the padding
  /// MajorantGrid::requiredPadding().
  ExtinctionBounds(const Grid& grid, const MinMaxGrid& ranges, const TransferFunction& transfer,
                   const Mixture* mixture = nullptr);

  const Size3& cellCount() const { return m_cellCount; }
  /// Size of a cell, voxels per axis.
  const Size3& edge() const { return m_edge; }
  /// World space to cell space, in which cell c covers [c, c + 1].
  const Affine& worldToCell() const { return m_worldToCell; }
  /// Corners of a cell enlarged by MajorantGrid::margin, world mm.
  Corners corners(const Size3& cell) const;

  /// Of components that the clip can remove, mm^-1.
  double clipped(std::size_t cell) const { return m_clipped[cell]; }
  /// Of components that it cannot remove, mm^-1.
  double unclipped(std::size_t cell) const { return m_unclipped.empty() ? 0.0 : m_unclipped[cell]; }

private:
  Size3 m_cellCount, m_edge;
  Affine m_worldToCell, m_cellToWorld;
  std::vector<double> m_clipped, m_unclipped; ///< unclipped: empty without a mixture
};

class MajorantGrid {
public:
  struct Cell {
    float majorant; ///< mm^-1
    bool isCut;     ///< clip weight may be below 1 in the cell: evaluate it at each collision
  };

  /// The majorant is the product of the cell's bound and the maximum, over the cell, of the clip
  /// weight times the style's factor.
  MajorantGrid(const ExtinctionBounds& bounds, const Clip& clip,
               const ContextStyle* style = nullptr);
  MajorantGrid(const Grid& grid, const MinMaxGrid& ranges, const TransferFunction& transfer,
               const Clip& clip, const ContextStyle* style = nullptr,
               const Mixture* mixture = nullptr)
      : MajorantGrid(ExtinctionBounds(grid, ranges, transfer, mixture), clip, style) {}

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
