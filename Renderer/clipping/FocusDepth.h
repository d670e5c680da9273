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

/// A context sample beside the focus, and the depth that it has to have.
struct RimDepth {
  std::int64_t sample;
  double depth; ///< mm
};

/// An eye ray, by its (x, y) on the plane through the target, and where it meets the focus; mm.
struct Meeting {
  Vec2 position;
  double depth;
};

/// Where the focus ends: context samples beside it, and rays between the samples that meet it
/// there.
struct Rim {
  std::vector<RimDepth> samples;
  std::vector<Meeting> meetings;
};

/// Depth per distance, both in mm on the plane through the target, between a sample of the focus
/// and its rim.
constexpr double steepestRim = 4.0;

class FocusCells;

/// Follows eye rays to a focus.
class FocusTracer {
public:
  FocusTracer(const Camera& camera, const Domain& volume, const Mask& focus);
  ~FocusTracer();

  /// As traceFocus.
  FocusDepth depths() const;

  /// The rim: context samples that share a cell of four samples with some of the focus. The focus
  /// ends in such cells, and often falls away there, while the surface is linear. Rays between the
  /// samples tell how deep the rim has to be for the surface not to hide the focus before it ends.
  /// Where the focus falls away more steeply than the surface may by itself, the rim is so deep, up
  /// to a limit; elsewhere it is as other context.
  Rim rim(const FocusDepth& focus) const;

private:
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
