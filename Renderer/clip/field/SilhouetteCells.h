#pragma once
// Seams: cells of the buffer in which the exact surface meets the focus between the samples.
//
// Samples are too far apart to resolve the outline of the focus and its depth between them. In a
// seam every look-up of a point therefore queries the focus itself, along the eye ray through the
// point:
// - the ray meets the focus: the surface is there;
// - the ray just misses: the surface is at the ray's summit (FocusCells). On the outline the summit
//   is the edge of the focus, so the surface has no step there. As the summit's height falls from
//   1/2 to the foothill, within about half a voxel, the surface passes linearly into the buffer's
//   interpolated depth.
// Rim samples, beside the focus but with a summit, get the summit's depth. The fill starts at the
// rim, so that the surface leaves the focus at its outline and not at the last focus sample.
//
// A seam's reach bounds the depths that its rays can meet; points outside the reach need no query.
// In an inner seam, where all samples are focus, the reach is the range of the samples around, made
// twice as long away from the eye. Spikes and pits that are narrower than the sample spacing and
// leave the reach are cut off.

#include "clip/focus/FocusDepth.h"

namespace fenestra {

struct CellRange;

class SilhouetteCells {
public:
  SilhouetteCells(std::shared_ptr<const FocusTracer> tracer, const FocusDepth& focus);

  /// Sample beside the focus whose ray has a summit.
  struct HaloSample {
    std::int64_t sample;
    double depth; ///< of the summit, mm
  };
  const std::vector<HaloSample>& halo() const { return m_halo; }

  /// Moves the surface `offset` mm away from the eye.
  void move(double offset);

  /// numbers()[s]: seam of the cell whose top-left sample is s; -1: none.
  const std::vector<std::int32_t>& indices() const { return m_indices; }

  /// Range of depths, mm, relative to the target.
  struct DepthBounds {
    float min, max;

    /// Shortest range that holds both.
    friend DepthBounds enclose(const DepthBounds& a, const DepthBounds& b) {
      return {std::min(a.min, b.min), std::max(a.max, b.max)};
    }
  };
  /// reaches()[seam]: bounds of the depths of focus and summits on the seam's rays.
  const std::vector<DepthBounds>& depthBounds() const { return m_depthBounds; }
  /// Reach of the cell whose top-left sample is `sample`; null: the cell is no seam.
  const DepthBounds* findDepthBounds(std::int64_t sample) const {
    const std::int32_t cell = m_indices[static_cast<std::size_t>(sample)];
    return cell < 0 ? nullptr : &m_depthBounds[static_cast<std::size_t>(cell)];
  }

  /// True: all four samples around the seam are focus.
  bool isInner(std::int32_t cell) const { return m_isInner[static_cast<std::size_t>(cell)]; }

  /// Query at one point; depths in mm, relative to the target.
  struct Query {
    std::int32_t cell;
    Vec2 position;    ///< in the seam, mm
    double depth;     ///< in: interpolated from the buffer's samples; out: exact
    double nearLimit; ///< depths <= `from` need not be exact: any value <= `from` may be returned
  };
  /// Replaces each question's `surface` by the exact surface depth. At most `maxQueries` a call.
  void evaluate(std::span<Query> queries) const;
  static constexpr std::size_t maxQueries = 16;

private:
  Interval joinDepthBounds(const DepthBuffer& buffer, std::int64_t column, std::int64_t row) const;
  void findHalo(const FocusDepth& focus, const CellRange& range);

  std::shared_ptr<const FocusTracer> m_tracer;
  double m_reference; ///< depth of the camera's target, mm
  double m_offset = 0.0;
  std::vector<std::int32_t> m_indices;
  std::vector<DepthBounds> m_depthBounds;
  std::vector<bool> m_isInner; ///< per seam
  std::vector<HaloSample> m_halo;
};

} // namespace fenestra
