#include "clipping/FocusDepth.h"

#include "clipping/FocusCells.h"
#include "clipping/Footprints.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>

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

/// Rays that are traced together. What is met is told to `meet(number of the ray, depth in mm)`.
template <typename Meet>
class FocusBatch {
public:
  FocusBatch(const FocusCells& cells, const Meet& meet)
      : m_cells(cells), m_box(cells.box()), m_meet(meet) {}

  /// A ray of the cells' space.
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
    m_cells.findMeetings(m_rays);
    for (std::size_t i = 0; i < m_rays.size; ++i)
      if (m_rays.meeting[i] < infinity)
        m_meet(m_numbers[i], m_rays.meeting[i] * m_depthPerLength[i]);
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

/// Whether nothing of the focus reaches out of the volume or its crop.
bool isInside(const FocusCells& cells, const Domain& volume) {
  const Affine toIndex = volume.grid().worldToIndex * cells.cellToWorld();
  const Box box = cells.box();
  for (int corner = 0; corner < 8; ++corner)
    if (!volume.contains(toIndex * box.corner(corner)))
      return false;
  return true;
}

/// Cells as FocusTracer::seams finds them, without their depths but at the samples.
std::vector<Seam> findSeams(const FocusDepth& focus) {
  const DepthBuffer& buffer = focus.depth;
  std::vector<Seam> seams;
  for (std::int64_t row = 0; row + 1 < buffer.rows(); ++row) {
    const Region* const above = &focus.regions[static_cast<std::size_t>(buffer.sample(0, row))];
    const Region* const below = above + buffer.columns();
    const auto inColumn = [&](std::int64_t column) {
      return (above[column] == Region::focus) + (below[column] == Region::focus);
    };
    for (std::int64_t column = 0; column + 1 < buffer.columns(); ++column) {
      const int count = inColumn(column) + inColumn(column + 1);
      if (count == 0)
        continue;
      const std::array corners{
          buffer.at(buffer.sample(column, row)), buffer.at(buffer.sample(column + 1, row)),
          buffer.at(buffer.sample(column, row + 1)), buffer.at(buffer.sample(column + 1, row + 1))};
      const auto [least, greatest] = std::ranges::minmax(corners);
      const double pitch =
          std::abs(buffer.xAxis().coordinate(column + 1) - buffer.xAxis().coordinate(column));
      if (count == 4 && greatest - least <= steepestCell * pitch)
        continue;
      Seam& seam = seams.emplace_back(Seam{column, row, {}});
      seam.depths.fill(infinity);
      constexpr std::size_t last = Seam::across - 1;
      seam.depths[0] = corners[0];
      seam.depths[last] = corners[1];
      seam.depths[last * Seam::across] = corners[2];
      seam.depths[last * Seam::across + last] = corners[3];
    }
  }
  return seams;
}

bool isSample(int corner) {
  constexpr int last = Seam::across - 1;
  return corner % Seam::across % last == 0 && corner / Seam::across % last == 0;
}

/// The part of a world ray in the volume's domain.
Interval inVolume(const Domain& volume, const Ray& ray) {
  return volume.clip(transformed(volume.grid().worldToIndex, ray));
}

} // namespace

FocusTracer::FocusTracer(const Camera& camera, const Domain& volume, const Mask& focus)
    : m_camera(camera),
      m_volume(volume),
      m_cells(std::make_unique<const FocusCells>(focus)),
      m_isWhole(isInside(*m_cells, volume)) {}

FocusTracer::~FocusTracer() = default;

FocusDepth FocusTracer::depths() const {
  FocusDepth result{DepthBuffer(m_camera, m_volume.grid()), {}};
  DepthBuffer& depth = result.depth;
  result.regions.assign(static_cast<std::size_t>(depth.size()), Region::outside);
  const FocusFootprint focusFootprint(m_camera, depth, *m_cells);
  const DomainFootprint domainFootprint(m_camera, m_volume);
  const CellRays cellRays(m_camera, *m_cells);

  const auto meetsVolume = [&](std::int64_t column, std::int64_t row) {
    return !inVolume(m_volume, m_camera.rayThrough(depth.position(column, row))).empty();
  };
  const auto traceRow = [&](std::int64_t row, auto& batch) {
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
      Interval range = m_isWhole ? Interval{} : inVolume(m_volume, m_camera.rayThrough(position));
      range.begin = std::max(range.begin, depths.begin / depthPerLength);
      range.end = std::min(range.end, depths.end / depthPerLength);
      batch.add(sample, ray, range, depthPerLength);
    }
  };
  const auto meet = [&result](std::int64_t sample, double met) {
    result.depth.set(sample, met);
    result.regions[static_cast<std::size_t>(sample)] = Region::focus;
  };
  tbb::parallel_for(tbb::blocked_range<std::int64_t>(0, depth.rows()), [&](const auto& rows) {
    FocusBatch batch(*m_cells, meet);
    for (std::int64_t row = rows.begin(); row < rows.end(); ++row)
      traceRow(row, batch);
    batch.trace();
  });
  return result;
}

template <typename Rays, typename Meet>
void FocusTracer::traceAll(std::size_t count, const Rays& rays, const Meet& meet) const {
  const CellRays cellRays(m_camera, *m_cells);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count), [&](const auto& range) {
    FocusBatch batch(*m_cells, meet);
    const auto add = [&](std::int64_t number, const Vec2& position) {
      const auto [ray, depthPerLength] = cellRays.through(position);
      const Interval inDomain =
          m_isWhole ? Interval{} : inVolume(m_volume, m_camera.rayThrough(position));
      batch.add(number, ray, inDomain, depthPerLength);
    };
    for (std::size_t i = range.begin(); i < range.end(); ++i)
      rays(i, add);
    batch.trace();
  });
}

std::vector<double> FocusTracer::depthsAt(const std::vector<Vec2>& positions) const {
  std::vector<double> depths(positions.size(), infinity);
  traceAll(
      positions.size(),
      [&](std::size_t i, const auto& add) { add(static_cast<std::int64_t>(i), positions[i]); },
      [&](std::int64_t i, double depth) { depths[static_cast<std::size_t>(i)] = depth; });
  return depths;
}

std::vector<Seam> FocusTracer::seams(const FocusDepth& focus) const {
  std::vector<Seam> seams = findSeams(focus);
  constexpr auto corners = static_cast<std::int64_t>(Seam::corners);
  traceAll(
      seams.size(),
      [&](std::size_t i, const auto& add) {
        const Vec2 low = focus.depth.position(seams[i].column, seams[i].row);
        const Vec2 high = focus.depth.position(seams[i].column + 1, seams[i].row + 1);
        for (int corner = 0; corner < corners; ++corner)
          if (!isSample(corner))
            add(static_cast<std::int64_t>(i) * corners + corner,
                Vec2(low + Seam::fraction(corner).cwiseProduct(high - low)));
      },
      [&](std::int64_t number, double depth) {
        seams[static_cast<std::size_t>(number / corners)]
            .depths[static_cast<std::size_t>(number % corners)] = depth;
      });
  return seams;
}

FocusDepth traceFocus(const Camera& camera, const Domain& volume, const Mask& focus) {
  return FocusTracer(camera, volume, focus).depths();
}

} // namespace fenestra
