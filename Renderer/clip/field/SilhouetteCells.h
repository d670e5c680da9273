#pragma once
// Silhouette cells: depth buffer cells in which the surface follows the focus between the samples.
//
// The samples are too coarse to resolve the outline of the focus, and its depth in between. In a
// silhouette cell, each look-up of the surface therefore queries the focus itself, along the camera
// ray through the point:
// - If the ray hits the focus, the surface is there.
// - If it misses, the surface is the interpolated depth of the buffer. There, the focus samples at
//   the outline have the depth of the surface beside them (ClippingSurface.cxx), so that it does
//   not rise toward the focus. Only in a narrow strip along the outline, where the ray maximum is
//   nearly 1/2, it blends linearly into the depth of the ray maximum, so that it has no step.
// Halo samples lie beside the focus and have a ray maximum (FocusCells). At the outline this is the
// edge of the focus. The fill starts at the halo, so that the surface leaves the focus at its
// outline, not at the last focus sample. Ray maxima lie near planes of voxels, and jump from one to
// another along the outline; the surface would have notches and pleats. The depth of a halo sample
// is therefore their mean along the outline.
//
//   row of samples, camera above               indicator along a ray that barely misses
//    context   halo    focus                     1/2 - - - - - - - - - - -
//       o───────o───────●───────●                        .-^-.    ray maximum
//         silhouette    |                        1/4 - -/- - -\- - -   captureThreshold
//      filled surface   | exact                     ___/       \____
//
// A slot is a strip of the focus along its outline, narrower than a voxel or one sample wide, that
// lies farther away than both the focus beside it and the surface at its outline: the rim of a
// farther part of the focus behind a nearer one. As a part of the outline it would be a dark, deep
// groove. Slots are closed: they count as context, and no part of the focus beyond them as a hit.
//
// The depth bounds of a cell contain all depths at which its rays can hit the focus; points outside
// them need no query. In an inner cell, where all samples are focus, they are the depth range of
// the samples around it, extended away from the camera to twice its length. Spikes and pits that
// are narrower than the sample spacing and exceed the bounds are cut off.

#include "clip/focus/FocusDepth.h"

#include <unordered_map>

namespace fenestra::core {

struct CellRange;

class SilhouetteCells {
public:
  /// Closes the slots of `focus`: their samples become context.
  SilhouetteCells(std::shared_ptr<const FocusTracer> tracer, FocusDepth& focus);

  const FocusTracer& tracer() const { return *m_tracer; }
  double offset() const { return m_offset; } ///< sum of all moves, mm

  /// Sample beside the focus whose ray has a maximum.
  struct HaloSample {
    std::int64_t sample;
    double rayMaximum; ///< depth, mm
    double depth;      ///< mm; mean of the ray maxima around it
  };
  const std::vector<HaloSample>& halo() const { return m_halo; }

  /// Moves the surface `offset` mm away from the camera.
  void move(double offset);

  /// Per sample: index of the silhouette cell whose top-left sample it is, or -1.
  const std::vector<std::int32_t>& indices() const { return m_indices; }

  /// Depth interval, mm, relative to the target.
  struct DepthBounds {
    float min, max;

    /// Smallest interval that contains both.
    friend DepthBounds enclose(const DepthBounds& a, const DepthBounds& b) {
      return {std::min(a.min, b.min), std::max(a.max, b.max)};
    }
  };
  /// Per silhouette cell: bounds of the depths of hits and ray maxima.
  const std::vector<DepthBounds>& depthBounds() const { return m_depthBounds; }
  /// Depth bounds of the cell whose top-left sample is `sample`; null if it is no silhouette cell.
  const DepthBounds* findDepthBounds(std::int64_t sample) const {
    const std::int32_t cell = m_indices[static_cast<std::size_t>(sample)];
    return cell < 0 ? nullptr : &m_depthBounds[static_cast<std::size_t>(cell)];
  }

  /// True if all four samples of the cell are focus.
  bool isInner(std::int32_t cell) const { return m_isInner[static_cast<std::size_t>(cell)]; }

  /// Query at one point; depths in mm, relative to the target.
  struct Query {
    std::int32_t cell;
    Vec2 position;    ///< in the cell, mm
    double depth;     ///< in: interpolated from the samples; out: exact
    double nearLimit; ///< if the surface is at or before this depth, any such depth may be returned
  };
  /// Replaces each query's `depth` by the exact surface depth. At most maxQueries per call.
  void evaluate(std::span<Query> queries) const;
  static constexpr std::size_t maxQueries = 16;

private:
  /// Samples of the focus in slots, and the depth, mm, beyond which it is ignored in their cells.
  using Slots = std::unordered_map<std::int64_t, double>;

  void findCells(const FocusDepth& focus, const Slots& slots);
  Slots findSlots(const FocusDepth& focus) const;
  double voxelEdge() const; ///< the longest edge of the focus's voxels, mm
  Interval joinDepthBounds(const DepthBuffer& buffer, std::int64_t column, std::int64_t row) const;
  void findHalo(const FocusDepth& focus, const CellRange& range);
  void smoothHalo(const DepthBuffer& buffer);

  std::shared_ptr<const FocusTracer> m_tracer;
  double m_reference; ///< depth of the camera's target, mm
  double m_offset = 0.0;
  std::vector<std::int32_t> m_indices;
  std::vector<DepthBounds> m_depthBounds;
  std::vector<bool> m_isInner; ///< per silhouette cell
  std::vector<HaloSample> m_halo;
};

} // namespace fenestra::core
