#pragma once
// Where the eye first meets the focus.

#include "clip/focus/DepthBuffer.h"
#include "model/volume/Domain.h"
#include "model/volume/Mask.h"

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace fenestra {

/// What an eye ray meets: the focus; the volume's domain but not the focus; neither.
enum class Region : std::uint8_t { outside, context, focus };

struct FocusDepth {
  DepthBuffer depth;           ///< of the focus, infinite elsewhere
  std::vector<Region> regions; ///< of each sample of `depth`

  bool isFocus(std::int64_t column, std::int64_t row) const {
    return column >= 0 && row >= 0 && column < depth.columns() && row < depth.rows() &&
           regions[static_cast<std::size_t>(depth.sample(column, row))] == Region::focus;
  }
};

class CellRays;
class FocusCells;

/// What to look at along an eye ray.
struct Glance {
  Vec2 position;   ///< (x, y) of the ray, mm
  Interval depths; ///< mm
};

/// What is seen there.
struct Sight {
  /// Where the ray meets the focus; else, where it passes it, of the first point at which the
  /// focus's indicator is greatest. A ray that leaves the focus goes from one to the other without
  /// a step.
  double depth = infinity;
  double indicator = 0.0; ///< 1/2 where the focus is met; 0 where it is foothill or less
};

/// Follows eye rays to a focus, of which and of the volume it keeps what it needs.
class FocusTracer {
public:
  FocusTracer(const Camera& camera, const Domain& volume, const Mask& focus);
  ~FocusTracer();

  /// As traceFocus.
  FocusDepth depths() const;

  /// Of the rays through these (x, y), mm; infinity where they miss the focus.
  std::vector<double> depthsAt(const std::vector<Vec2>& positions) const;

  /// One sight for each glance; `meet` tells of what is met alone, and costs less. For few of them,
  /// or in parallel: they are looked at here and now.
  void meet(std::span<const Glance> glances, std::span<Sight> sights) const;
  void look(std::span<const Glance> glances, std::span<Sight> sights) const;

  /// Whether the ray through (x, y) is in the focus, and the volume, at this depth, mm.
  bool isFocus(const Vec2& position, double depth) const;

  const Camera& camera() const { return m_camera; }
  const FocusCells& cells() const { return *m_cells; }

private:
  Interval inDomain(const Vec2& position) const;
  template <bool withSummits>
  void follow(std::span<const Glance> glances, std::span<Sight> sights) const;

  Camera m_camera;
  Domain m_volume;
  std::unique_ptr<const FocusCells> m_cells;
  std::unique_ptr<const CellRays> m_rays;
  bool m_isWhole; ///< nothing of the focus reaches out of the volume or its crop
};

/// The depth at which the ray of each sample first meets the 0.5 level of the focus inside the
/// volume's domain and in front of the eye: exact, to rounding. A ray that starts, or enters the
/// domain, inside the focus meets it there. The buffer spans the whole volume, cropped or not.
FocusDepth traceFocus(const Camera& camera, const Domain& volume, const Mask& focus);

} // namespace fenestra
