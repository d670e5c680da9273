#include "clipping/FocusDepth.h"

#include "clipping/FocusCells.h"
#include "clipping/Footprints.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

namespace fenestra {
namespace {

/// The camera's eye rays in the cells' space: each is found there, and none transformed.
class CellRays {
public:
  CellRays(const Camera& camera, const FocusCells& cells)
      : m_orthographic(camera.pose().projection == Projection::orthographic),
        m_targetDepth(camera.targetDepth()),
        m_eye(cells.worldToCell() * camera.pose().position),
        m_right(cells.worldToCell().linear() * camera.right()),
        m_up(cells.worldToCell().linear() * camera.up()),
        m_forward(cells.worldToCell().linear() * camera.forward()) {}

  struct EyeRay {
    Ray ray; ///< its parameter in world mm
    double depthPerLength;
  };
  /// As Camera::rayThrough.
  EyeRay through(const Vec2& plane) const {
    const Vec3 offset = plane.x() * m_right + plane.y() * m_up;
    if (m_orthographic)
      return {{m_eye + offset, m_forward}, 1.0};
    const double perLength = 1.0 / std::sqrt(plane.squaredNorm() + m_targetDepth * m_targetDepth);
    return {{m_eye, perLength * (offset + m_targetDepth * m_forward)}, m_targetDepth * perLength};
  }

private:
  bool m_orthographic;
  double m_targetDepth;
  Vec3 m_eye, m_right, m_up, m_forward;
};

/// Samples whose rays are traced together.
class FocusBatch {
public:
  FocusBatch(const FocusCells& cells, FocusDepth& result)
      : m_cells(cells), m_box(cells.box()), m_result(result) {}

  /// A ray of the cells' space.
  void add(std::int64_t sample, const Ray& ray, const Interval& range, double depthPerLength) {
    const Interval inside = m_box.clip(ray, range);
    if (inside.empty())
      return;
    const std::size_t i = m_rays.size++;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      m_rays.origin[axis][i] = ray.origin[static_cast<int>(axis)];
      m_rays.direction[axis][i] = ray.direction[static_cast<int>(axis)];
    }
    m_rays.begin[i] = inside.begin;
    m_rays.end[i] = inside.end;
    m_samples[i] = sample;
    m_depthPerLength[i] = depthPerLength;
    if (m_rays.full())
      trace();
  }

  void trace() {
    m_cells.findMeetings(m_rays);
    for (std::size_t i = 0; i < m_rays.size; ++i)
      if (m_rays.meeting[i] < infinity) {
        m_result.depth.set(m_samples[i], m_rays.meeting[i] * m_depthPerLength[i]);
        m_result.regions[static_cast<std::size_t>(m_samples[i])] = Region::focus;
      }
    m_rays.size = 0;
  }

private:
  const FocusCells& m_cells;
  Box m_box;
  FocusDepth& m_result;
  FocusRays m_rays;
  std::array<std::int64_t, FocusRays::capacity> m_samples;
  FocusRays::Column m_depthPerLength;
};

/// Whether nothing of the focus reaches out of the volume or its crop.
bool isInside(const FocusCells& cells, const Domain& volume) {
  const Affine toIndex = volume.grid().worldToIndex * cells.cellToWorld();
  const Box box = cells.box();
  for (int corner = 0; corner < 8; ++corner)
    if (!volume.contains(toIndex * box.corner(corner)))
      return false;
  return true;
}

} // namespace

FocusDepth traceFocus(const Camera& camera, const Domain& volume, const Mask& focus) {
  FocusDepth result{DepthBuffer(camera, volume.grid()), {}};
  DepthBuffer& depth = result.depth;
  result.regions.assign(static_cast<std::size_t>(depth.size()), Region::outside);
  const FocusCells cells(focus);
  const FocusFootprint focusFootprint(camera, depth, cells);
  const DomainFootprint domainFootprint(camera, volume);
  const bool isWhole = isInside(cells, volume);
  const CellRays cellRays(camera, cells);

  const auto inVolume = [&](const Ray& ray) {
    return volume.clip(transformed(volume.grid().worldToIndex, ray));
  };
  const auto meetsVolume = [&](std::int64_t column, std::int64_t row) {
    return !inVolume(camera.rayThrough(depth.position(column, row))).empty();
  };
  const auto traceRow = [&](std::int64_t row, FocusBatch& batch) {
    // The domain is convex: all between two samples that meet it do.
    auto [first, end] = domainFootprint.columns(depth, row);
    while (first < end && !meetsVolume(first, row))
      ++first;
    while (first < end && !meetsVolume(end - 1, row))
      --end;
    for (std::int64_t column = first; column < end; ++column) {
      const std::int64_t sample = depth.sample(column, row);
      result.regions[static_cast<std::size_t>(sample)] = Region::context;
      const Interval depths = focusFootprint.depths(column, row);
      if (depths.empty())
        continue;
      const Vec2 position = depth.position(column, row);
      const auto [ray, depthPerLength] = cellRays.through(position);
      Interval range = isWhole ? Interval{} : inVolume(camera.rayThrough(position));
      range.begin = std::max(range.begin, depths.begin / depthPerLength);
      range.end = std::min(range.end, depths.end / depthPerLength);
      batch.add(sample, ray, range, depthPerLength);
    }
  };
  tbb::parallel_for(tbb::blocked_range<std::int64_t>(0, depth.rows()), [&](const auto& rows) {
    FocusBatch batch(cells, result);
    for (std::int64_t row = rows.begin(); row < rows.end(); ++row)
      traceRow(row, batch);
    batch.trace();
  });
  return result;
}

} // namespace fenestra
