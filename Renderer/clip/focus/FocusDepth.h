#pragma once
// Depth of the first intersection of each camera ray with the focus.

#include "clip/focus/DepthBuffer.h"
#include "model/volume/Domain.h"
#include "model/volume/Mask.h"

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace fenestra::core {

/// What a camera ray hits: nothing (outside), only the volume's domain (context), or the focus.
enum class Region : std::uint8_t { outside, context, focus };

struct FocusDepth {
  DepthBuffer depth;           ///< of the focus, mm; infinity if missed
  std::vector<Region> regions; ///< one per sample of `depth`

  bool isFocus(std::int64_t column, std::int64_t row) const {
    return column >= 0 && row >= 0 && column < depth.columns() && row < depth.rows() &&
           regions[static_cast<std::size_t>(depth.sample(column, row))] == Region::focus;
  }

  /// Calls visit(Vec3(x, y, depth)), mm, for each focus sample.
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

/// Camera ray, and the depths to search on it.
struct DepthQuery {
  Vec2 position;        ///< (x, y) on the plane through the target, mm
  Interval depths = {}; ///< mm
};

/// Result of a query.
struct DepthHit {
  /// mm; of the hit, else of the ray maximum (FocusCells), else infinity. Continuous from ray to
  /// ray across the outline of the focus.
  double depth = infinity;
  double indicator = 0.0; ///< 1/2: hit; in (captureThreshold, 1/2): ray maximum; 0: neither
};

/// Intersects camera rays with the surface of a focus. Copies what it needs of mask and volume.
class FocusTracer {
public:
  FocusTracer(const Camera& camera, const Domain& volume, const Mask& focus);
  ~FocusTracer();

  /// Intersects the ray of each sample with the level 0.5 of the focus, inside the volume's domain
  /// and in front of the camera. Depths are exact to rounding: roots of a cubic, not ray-marched. A
  /// ray that starts, or enters the domain, inside the focus hits it there. The buffer covers the
  /// volume without its crop.
  FocusDepth traceDepths() const;

  /// Depths of the focus on the rays through these (x, y), mm; infinity if missed.
  std::vector<double> findDepths(const std::vector<Vec2>& positions) const;

  /// Sets hits[i] for queries[i]. findHits ignores ray maxima and is cheaper. Both run on the
  /// calling thread, so that callers can parallelize.
  void findHits(std::span<const DepthQuery> queries, std::span<DepthHit> hits) const;
  void findHitsAndMaxima(std::span<const DepthQuery> queries, std::span<DepthHit> hits) const;

  /// True if the point at (x, y) and `depth`, mm, lies inside both focus and domain.
  bool isFocus(const Vec2& position, double depth) const;

  const Camera& camera() const { return m_camera; }
  const FocusCells& cells() const { return *m_cells; }
  const Domain& domain() const { return m_volume; }
  /// True if the domain contains the complete grid of the focus.
  bool isFocusInside() const { return m_isInside; }

private:
  Interval clipToDomain(const Vec2& position) const;
  template <bool withMaxima>
  void trace(std::span<const DepthQuery> queries, std::span<DepthHit> hits) const;

  Camera m_camera;
  Domain m_volume;
  std::unique_ptr<const FocusCells> m_cells;
  std::unique_ptr<const CellRays> m_rays;
  bool m_isInside; ///< isFocusInside
};

} // namespace fenestra::core
