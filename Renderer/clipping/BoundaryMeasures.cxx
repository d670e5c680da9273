#include "clipping/BoundaryMeasures.h"

#include "clipping/Contour.h"

#include <algorithm>
#include <numeric>

namespace fenestra {

namespace {

/// What the eye ray of a sample meets: depths in mm, infinity where there is nothing.
class Depths {
public:
  Depths(const Clip& clip, const Domain& volume, const FocusDepth& focus)
      : m_clip(clip),
        m_volume(volume),
        m_focus(focus),
        m_camera(std::visit(
            [](const auto& kind) -> const Camera* {
              if constexpr (std::is_same_v<std::decay_t<decltype(kind)>, ClipNone>)
                return nullptr;
              else
                return &kind.camera;
            },
            clip)) {}

  bool known() const { return m_camera != nullptr; }

  double focus(std::int64_t column, std::int64_t row) const {
    return m_focus.isFocus(column, row) ? m_focus.depth.at(m_focus.depth.sample(column, row))
                                        : infinity;
  }

  /// Where what is left of the volume begins.
  double context(std::int64_t column, std::int64_t row) const {
    const DepthBuffer& buffer = m_focus.depth;
    if (column < 0 || row < 0 || column >= buffer.columns() || row >= buffer.rows())
      return infinity;
    const Ray ray = m_camera->rayThrough(buffer.position(column, row));
    const Interval part =
        m_volume.clip(transformed(m_volume.grid().worldToIndex, ray), behindSurface(m_clip, ray));
    return part.empty() ? infinity : part.begin * m_camera->depthPerLength(ray);
  }

  /// Whether the focus's own depth jumps at one of its samples.
  bool jumps(std::int64_t column, std::int64_t row) const {
    const double own = focus(column, row);
    for (std::int64_t y = row - 1; y <= row + 1; ++y)
      for (std::int64_t x = column - 1; x <= column + 1; ++x)
        if (const double other = focus(x, y); other < infinity && std::abs(other - own) > depthJump)
          return true;
    return false;
  }

private:
  const Clip& m_clip;
  const Domain& m_volume;
  const FocusDepth& m_focus;
  const Camera* m_camera; ///< null without a clip
};

} // namespace

Distribution Distribution::of(std::vector<double> values) {
  if (values.empty())
    return {};
  std::ranges::sort(values);
  const auto count = static_cast<double>(values.size());
  return {std::accumulate(values.begin(), values.end(), 0.0) / count,
          values[static_cast<std::size_t>(0.95 * (count - 1.0))], values.back()};
}

BoundaryMeasures measureBoundary(const Clip& clip, const Domain& volume, const FocusDepth& focus) {
  const Depths depths(clip, volume, focus);
  BoundaryMeasures measures;
  if (!depths.known())
    return measures;
  std::vector<double> gaps, slopeJumps;
  std::size_t jumps = 0;
  for (const Contour& contour : traceContours(focus))
    for (const Crossing& crossing : contour) {
      const auto [x, y] = outward(crossing);
      const std::int64_t column = crossing.column, row = crossing.row;
      const double own = depths.focus(column, row), inner = depths.focus(column - x, row - y);
      const double near = depths.context(column + x, row + y);
      const double far = depths.context(column + 2 * x, row + 2 * y);
      if (!(near < infinity && far < infinity) || focus.isFocus(column + 2 * x, row + 2 * y))
        continue;
      ++measures.crossings;
      if (depths.jumps(column, row)) {
        ++jumps;
        continue;
      }
      gaps.push_back(std::abs(2.0 * near - far - own));
      const double pitch =
          (focus.depth.position(column + x, row + y) - focus.depth.position(column, row)).norm();
      if (inner < infinity)
        slopeJumps.push_back(std::abs((far - near) - (own - inner)) / pitch);
    }
  measures.gap = Distribution::of(std::move(gaps));
  measures.slopeJump = Distribution::of(std::move(slopeJumps));
  if (measures.crossings > 0)
    measures.depthJumps = static_cast<double>(jumps) / static_cast<double>(measures.crossings);
  return measures;
}

} // namespace fenestra
