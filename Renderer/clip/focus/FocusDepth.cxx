#include "clip/focus/FocusDepth.h"

#include "clip/focus/FocusCells.h"
#include "clip/focus/Footprints.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>

namespace fenestra::core {

/// Generates camera rays directly in cell space, so that no ray needs a transform.
class CellRays {
public:
  CellRays(const Camera& camera, const FocusCells& cells)
      : m_orthographic(camera.pose().projection == Projection::orthographic),
        m_targetDepth(camera.targetDepth()),
        m_position(cells.worldToCell() * camera.pose().position),
        m_right(cells.worldToCell().linear() * camera.right()),
        m_up(cells.worldToCell().linear() * camera.up()),
        m_forward(cells.worldToCell().linear() * camera.forward()) {}

  struct CameraRay {
    Ray ray; ///< in cell space; its parameter is in world mm
    double depthPerLength;
  };
  /// Camera::makePlaneRay in cell space.
  CameraRay makeRay(const Vec2& plane) const {
    const Vec3 offset = plane.x() * m_right + plane.y() * m_up;
    if (m_orthographic)
      return {{m_position + offset, m_forward}, 1.0};
    const double perLength = 1.0 / std::sqrt(plane.squaredNorm() + m_targetDepth * m_targetDepth);
    return {{m_position, perLength * (offset + m_targetDepth * m_forward)},
            m_targetDepth * perLength};
  }

private:
  bool m_orthographic;
  double m_targetDepth;
  Vec3 m_position, m_right, m_up, m_forward;
};

namespace {

/// True if the domain contains the complete grid of the focus.
bool isInside(const FocusCells& cells, const Domain& volume) {
  const Affine toIndex = volume.grid().worldToIndex * cells.cellToWorld();
  const Box box = cells.box();
  for (int corner = 0; corner < 8; ++corner)
    if (!volume.contains(toIndex * box.corner(corner)))
      return false;
  return true;
}

/// Clips a world ray to the volume's domain.
Interval clipToVolume(const Domain& volume, const Ray& ray) {
  return volume.clip(transformRay(volume.grid().worldToIndex, ray));
}

} // namespace

FocusTracer::FocusTracer(const Camera& camera, const Domain& volume, const Mask& focus)
    : m_camera(camera),
      m_volume(volume),
      m_cells(std::make_unique<const FocusCells>(focus)),
      m_rays(std::make_unique<const CellRays>(m_camera, *m_cells)),
      m_isInside(isInside(*m_cells, volume)) {}

FocusTracer::~FocusTracer() = default;

/// Interval of a camera ray in which it can hit the focus inside the volume's domain.
Interval FocusTracer::clipToDomain(const Vec2& position) const {
  return m_isInside ? Interval{} : clipToVolume(m_volume, m_camera.makePlaneRay(position));
}

FocusDepth FocusTracer::traceDepths() const {
  FocusDepth result{DepthBuffer(m_camera, m_volume.grid()), {}};
  DepthBuffer& depth = result.depth;
  result.regions.assign(static_cast<std::size_t>(depth.size()), Region::outside);
  const FocusFootprint focusFootprint(m_camera, depth, *m_cells);
  const DomainFootprint domainFootprint(m_camera, m_volume);

  const auto intersectsVolume = [&](std::int64_t column, std::int64_t row) {
    return !clipToVolume(m_volume, m_camera.makePlaneRay(depth.position(column, row))).isEmpty();
  };
  tbb::parallel_for(std::int64_t{0}, depth.rows(), [&](std::int64_t row) {
    // The domain is convex, so the samples whose rays meet it are contiguous.
    auto [first, end] = domainFootprint.columns(depth, row);
    while (first < end && !intersectsVolume(first, row))
      ++first;
    while (first < end && !intersectsVolume(end - 1, row))
      --end;
    std::vector<std::int64_t> samples;
    std::vector<DepthQuery> queries;
    for (std::int64_t column = first; column < end; ++column) {
      const std::int64_t sample = depth.sample(column, row);
      result.regions[static_cast<std::size_t>(sample)] = Region::context;
      const Interval depths = focusFootprint.depths(column, row);
      if (depths.isEmpty())
        continue;
      samples.push_back(sample);
      queries.push_back({depth.position(column, row), depths});
    }
    std::vector<DepthHit> hits(queries.size());
    findHits(queries, hits);
    for (std::size_t i = 0; i < hits.size(); ++i)
      if (hits[i].depth < infinity) {
        depth.set(samples[i], hits[i].depth);
        result.regions[static_cast<std::size_t>(samples[i])] = Region::focus;
      }
  });
  return result;
}

std::vector<double> FocusTracer::findDepths(const std::vector<Vec2>& positions) const {
  std::vector<double> depths(positions.size());
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, positions.size()), [&](const auto& range) {
    std::vector<DepthQuery> queries;
    for (std::size_t i = range.begin(); i < range.end(); ++i)
      queries.push_back({positions[i]});
    std::vector<DepthHit> hits(queries.size());
    findHits(queries, hits);
    for (std::size_t i = 0; i < hits.size(); ++i)
      depths[range.begin() + i] = hits[i].depth;
  });
  return depths;
}

bool FocusTracer::isFocus(const Vec2& position, double depth) const {
  const auto [ray, depthPerLength] = m_rays->makeRay(position);
  const double t = depth / depthPerLength;
  if (!(m_cells->indicator(ray.at(t)) >= 0.5))
    return false;
  const Affine& worldToIndex = m_volume.grid().worldToIndex;
  return m_isInside || m_volume.contains(worldToIndex * m_camera.makePlaneRay(position).at(t));
}

template <bool withMaxima>
void FocusTracer::trace(std::span<const DepthQuery> queries, std::span<DepthHit> hits) const {
  if (queries.empty())
    return;
  std::ranges::fill(hits, DepthHit{});
  FocusRays rays; // current batch
  std::array<DepthHit*, FocusRays::capacity> hitOfRay;
  FocusRays::SoaArray depthPerLength;
  const auto flush = [&] {
    if constexpr (withMaxima)
      m_cells->findHitsAndMaxima(rays);
    else
      m_cells->findHits(rays);
    for (std::size_t i = 0; i < rays.size; ++i)
      if (rays.hitT[i] < infinity)
        *hitOfRay[i] = {rays.hitT[i] * depthPerLength[i], 0.5};
      else if (withMaxima && rays.maximum[i] > FocusCells::captureThreshold)
        *hitOfRay[i] = {rays.maximumT[i] * depthPerLength[i], rays.maximum[i]};
    rays.size = 0;
  };
  for (std::size_t i = 0; i < queries.size(); ++i) {
    const auto [ray, perLength] = m_rays->makeRay(queries[i].position);
    Interval range = clipToDomain(queries[i].position);
    range.begin = std::max(range.begin, queries[i].depths.begin / perLength);
    range.end = std::min(range.end, queries[i].depths.end / perLength);
    const Interval inside = m_cells->box().clip(ray, range);
    if (inside.isEmpty())
      continue;
    hitOfRay[rays.size] = &hits[i];
    depthPerLength[rays.size] = perLength;
    rays.add(ray, inside);
    if (rays.isFull())
      flush();
  }
  flush();
}

void FocusTracer::findHits(std::span<const DepthQuery> queries, std::span<DepthHit> hits) const {
  trace<false>(queries, hits);
}

void FocusTracer::findHitsAndMaxima(std::span<const DepthQuery> queries,
                                    std::span<DepthHit> hits) const {
  trace<true>(queries, hits);
}

} // namespace fenestra::core
