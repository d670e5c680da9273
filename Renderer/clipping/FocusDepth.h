#pragma once
// Where the eye first meets the focus.

#include "clipping/DepthBuffer.h"
#include "volume/Domain.h"
#include "volume/Mask.h"

#include <cstdint>
#include <memory>
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

/// A cell between four samples in which the focus's depth is known more finely: on the corners of
/// the squares of a fine cell (DepthBuffer), row by row, infinity where it is missed; mm.
struct Seam {
  static constexpr int across = DepthBuffer::fineSide + 1;
  static constexpr std::size_t corners = std::size_t{across} * across;

  std::int64_t column, row; ///< of the cell's first sample
  std::array<double, corners> depths;

  /// Of a corner, in cells from the first sample.
  static Vec2 fraction(int corner) {
    return Vec2(corner % across, corner / across) / DepthBuffer::fineSide;
  }
};

/// Depth per distance between focus samples, both in mm on the plane through the target, from which
/// on what lies between them is looked at.
constexpr double steepestCell = 2.0;

class FocusCells;

/// Follows eye rays to a focus.
class FocusTracer {
public:
  FocusTracer(const Camera& camera, const Domain& volume, const Mask& focus);
  ~FocusTracer();

  /// As traceFocus.
  FocusDepth depths() const;

  /// Of the rays through these (x, y), mm; infinity where they miss the focus.
  std::vector<double> depthsAt(const std::vector<Vec2>& positions) const;

  /// The cells where the focus ends, or falls away more steeply than steepestCell: part of it may
  /// hide another there.
  std::vector<Seam> seams(const FocusDepth& focus) const;

private:
  /// rays(i, add) for each i adds rays by a number and their (x, y); meet(number, depth) is told of
  /// those that meet the focus.
  template <typename Rays, typename Meet>
  void traceAll(std::size_t count, const Rays& rays, const Meet& meet) const;

  const Camera& m_camera;
  const Domain& m_volume;
  std::unique_ptr<const FocusCells> m_cells;
  bool m_isWhole; ///< nothing of the focus reaches out of the volume or its crop
};

/// The depth at which the ray of each sample first meets the 0.5 level of the focus inside the
/// volume's domain and in front of the eye: exact, to rounding. A ray that starts, or enters the
/// domain, inside the focus meets it there. The buffer spans the whole volume, cropped or not.
FocusDepth traceFocus(const Camera& camera, const Domain& volume, const Mask& focus);

} // namespace fenestra
