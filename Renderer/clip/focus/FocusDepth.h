#pragma once
// Depth at which each eye ray first meets the focus.

#include "clip/focus/DepthBuffer.h"
#include "model/volume/Domain.h"
#include "model/volume/Mask.h"

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace fenestra {

/// Kind of an eye ray: misses the volume's domain; meets the domain only; meets the focus.
enum class Region : std::uint8_t { outside, context, focus };

struct FocusDepth {
  DepthBuffer depth;           ///< of the focus, mm; infinity: missed
  std::vector<Region> regions; ///< one per sample of `depth`

  bool isFocus(std::int64_t column, std::int64_t row) const {
    return column >= 0 && row >= 0 && column < depth.columns() && row < depth.rows() &&
           regions[static_cast<std::size_t>(depth.sample(column, row))] == Region::focus;
  }

  /// Calls back with each sample of the focus: its position (x, y) and depth, mm.
  template <typename Visitor>
  void visitFocus(const Visitor& visit) const {
    for (std::int64_t row = 0; row < depth.rows(); ++row)
      for (std::int64_t column = 0; column < depth.columns(); ++column)
        if (isFocus(column, row)) {
          const Vec2 at = depth.position(column, row);
          visit(Vec3(at.x(), at.y(), depth.at(depth.sample(column, row))));
        }
  }
};

class CellRays;
class FocusCells;

/// Stretch of an eye ray to search.
struct DepthQuery {
  Vec2 position;        ///< (x, y) of the ray, mm
  Interval depths = {}; ///< mm
};

/// Result for a glance.
struct DepthHit {
  /// mm, where the ray meets the focus, else at the ray's summit (FocusCells); infinity: neither.
  /// Continuous from ray to ray across the outline of the focus.
  double depth = infinity;
  double indicator = 0.0; ///< 1/2: focus met; (foothill, 1/2): summit's height; 0: neither
};

/// Intersects eye rays with the surface of a focus. Copies what it needs of mask and volume.
class FocusTracer {
public:
  FocusTracer(const Camera& camera, const Domain& volume, const Mask& focus);
  ~FocusTracer();

  /// Depth at which the ray of each sample first meets the 0.5 level of the focus inside the
  /// volume's domain and in front of the eye: exact, to rounding. A ray that starts, or enters the
  /// domain, inside the focus meets the focus there. The buffer spans the whole volume, cropped or
  /// not.
  FocusDepth traceDepths() const;

  /// Depths of the focus on the rays through these (x, y), mm; infinity: missed.
  std::vector<double> findDepths(const std::vector<Vec2>& positions) const;

  /// Fills sights[i] for glances[i]. `meet`: meetings only (cheaper); `look`: summits as well. Not
  /// threaded inside: to be called in parallel.
  void findHits(std::span<const DepthQuery> queries, std::span<DepthHit> hits) const;
  void findHitsAndMaxima(std::span<const DepthQuery> queries, std::span<DepthHit> hits) const;

  /// True if the ray through (x, y) is in focus and domain at this depth, mm.
  bool isFocus(const Vec2& position, double depth) const;

  const Camera& camera() const { return m_camera; }
  const FocusCells& cells() const { return *m_cells; }

private:
  Interval clipToDomain(const Vec2& position) const;
  template <bool withMaxima>
  void trace(std::span<const DepthQuery> queries, std::span<DepthHit> hits) const;

  Camera m_camera;
  Domain m_volume;
  std::unique_ptr<const FocusCells> m_cells;
  std::unique_ptr<const CellRays> m_rays;
  bool m_isInside; ///< true: the domain contains the focus's whole grid
};

} // namespace fenestra
