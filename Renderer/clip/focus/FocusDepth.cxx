#include "clip/focus/FocusDepth.h"

#include "clip/focus/FocusCells.h"
#include "clip/focus/Footprints.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>

namespace fenestra {

/// Camera's eye rays, built in cell space directly: no ray is transformed.
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
    Ray ray; ///< in cell space, its parameter in world mm
    double depthPerLength;
  };
  /// Camera::rayThrough in cell space.
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

namespace {

/// Rays that are traced together. Calls meet(number of the ray, sight) for each ray that meets the
/// focus, with summits also for each ray that has one.
template <bool withSummits, typename Meet>
class FocusBatch {
public:
  FocusBatch(const FocusCells& cells, const Meet& meet)
      : m_cells(cells), m_box(cells.box()), m_meet(meet) {}

  /// Adds a ray in cell space.
  void add(std::int64_t number, const Ray& ray, const Interval& range, double depthPerLength) {
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
    m_numbers[i] = number;
    m_depthPerLength[i] = depthPerLength;
    if (m_rays.full())
      trace();
  }

  void trace() {
    if constexpr (withSummits)
      m_cells.findSummits(m_rays);
    else
      m_cells.findMeetings(m_rays);
    for (std::size_t i = 0; i < m_rays.size; ++i)
      if (m_rays.meeting[i] < infinity)
        m_meet(m_numbers[i], Sight{m_rays.meeting[i] * m_depthPerLength[i], 0.5});
      else if (withSummits && m_rays.height[i] > FocusCells::foothill)
        m_meet(m_numbers[i], Sight{m_rays.summit[i] * m_depthPerLength[i], m_rays.height[i]});
    m_rays.size = 0;
  }

private:
  const FocusCells& m_cells;
  Box m_box;
  const Meet& m_meet;
  FocusRays m_rays;
  std::array<std::int64_t, FocusRays::capacity> m_numbers;
  FocusRays::Column m_depthPerLength;
};

/// True if the domain contains the whole grid of the focus.
bool isInside(const FocusCells& cells, const Domain& volume) {
  const Affine toIndex = volume.grid().worldToIndex * cells.cellToWorld();
  const Box box = cells.box();
  for (int corner = 0; corner < 8; ++corner)
    if (!volume.contains(toIndex * box.corner(corner)))
      return false;
  return true;
}

/// Part of a world ray in the volume's domain.
Interval inVolume(const Domain& volume, const Ray& ray) {
  return volume.clip(transformed(volume.grid().worldToIndex, ray));
}

} // namespace

FocusTracer::FocusTracer(const Camera& camera, const Domain& volume, const Mask& focus)
    : m_camera(camera),
      m_volume(volume),
      m_cells(std::make_unique<const FocusCells>(focus)),
      m_rays(std::make_unique<const CellRays>(m_camera, *m_cells)),
      m_isWhole(isInside(*m_cells, volume)) {}

FocusTracer::~FocusTracer() = default;

/// Part of an eye ray in which the ray can meet the focus inside the volume's domain.
Interval FocusTracer::inDomain(const Vec2& position) const {
  return m_isWhole ? Interval{} : inVolume(m_volume, m_camera.rayThrough(position));
}

FocusDepth FocusTracer::depths() const {
  FocusDepth result{DepthBuffer(m_camera, m_volume.grid()), {}};
  DepthBuffer& depth = result.depth;
  result.regions.assign(static_cast<std::size_t>(depth.size()), Region::outside);
  const FocusFootprint focusFootprint(m_camera, depth, *m_cells);
  const DomainFootprint domainFootprint(m_camera, m_volume);

  const auto meetsVolume = [&](std::int64_t column, std::int64_t row) {
    return !inVolume(m_volume, m_camera.rayThrough(depth.position(column, row))).empty();
  };
  const auto traceRow = [&](std::int64_t row, auto& batch) {
    // The domain is convex: all samples between two that meet the domain meet it.
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
      const auto [ray, depthPerLength] = m_rays->through(position);
      Interval range = inDomain(position);
      range.begin = std::max(range.begin, depths.begin / depthPerLength);
      range.end = std::min(range.end, depths.end / depthPerLength);
      batch.add(sample, ray, range, depthPerLength);
    }
  };
  const auto meet = [&result](std::int64_t sample, const Sight& met) {
    result.depth.set(sample, met.depth);
    result.regions[static_cast<std::size_t>(sample)] = Region::focus;
  };
  tbb::parallel_for(tbb::blocked_range<std::int64_t>(0, depth.rows()), [&](const auto& rows) {
    FocusBatch<false, decltype(meet)> batch(*m_cells, meet);
    for (std::int64_t row = rows.begin(); row < rows.end(); ++row)
      traceRow(row, batch);
    batch.trace();
  });
  return result;
}

std::vector<double> FocusTracer::depthsAt(const std::vector<Vec2>& positions) const {
  std::vector<double> depths(positions.size(), infinity);
  const auto meet = [&depths](std::int64_t i, const Sight& met) {
    depths[static_cast<std::size_t>(i)] = met.depth;
  };
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, positions.size()), [&](const auto& range) {
    FocusBatch<false, decltype(meet)> batch(*m_cells, meet);
    for (std::size_t i = range.begin(); i < range.end(); ++i) {
      const auto [ray, depthPerLength] = m_rays->through(positions[i]);
      batch.add(static_cast<std::int64_t>(i), ray, inDomain(positions[i]), depthPerLength);
    }
    batch.trace();
  });
  return depths;
}

bool FocusTracer::isFocus(const Vec2& position, double depth) const {
  const auto [ray, depthPerLength] = m_rays->through(position);
  const double t = depth / depthPerLength;
  if (!(m_cells->indicator(ray.at(t)) >= 0.5))
    return false;
  const Affine& worldToIndex = m_volume.grid().worldToIndex;
  return m_isWhole || m_volume.contains(worldToIndex * m_camera.rayThrough(position).at(t));
}

template <bool withSummits>
void FocusTracer::follow(std::span<const Glance> glances, std::span<Sight> sights) const {
  if (glances.empty())
    return;
  std::ranges::fill(sights, Sight{});
  const auto meet = [&sights](std::int64_t i, const Sight& met) {
    sights[static_cast<std::size_t>(i)] = met;
  };
  FocusBatch<withSummits, decltype(meet)> batch(*m_cells, meet);
  for (std::size_t i = 0; i < glances.size(); ++i) {
    const auto [ray, depthPerLength] = m_rays->through(glances[i].position);
    Interval range = inDomain(glances[i].position);
    range.begin = std::max(range.begin, glances[i].depths.begin / depthPerLength);
    range.end = std::min(range.end, glances[i].depths.end / depthPerLength);
    batch.add(static_cast<std::int64_t>(i), ray, range, depthPerLength);
  }
  batch.trace();
}

void FocusTracer::meet(std::span<const Glance> glances, std::span<Sight> sights) const {
  follow<false>(glances, sights);
}

void FocusTracer::look(std::span<const Glance> glances, std::span<Sight> sights) const {
  follow<true>(glances, sights);
}

FocusDepth traceFocus(const Camera& camera, const Domain& volume, const Mask& focus) {
  return FocusTracer(camera, volume, focus).depths();
}

} // namespace fenestra
