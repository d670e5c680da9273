#include "clipping/FocusDepth.h"

#include "clipping/FocusCells.h"
#include "clipping/Footprints.h"
#include "clipping/SmoothFill.h"

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

/// A square of four neighbouring samples, some of them focus and some not.
class RimCell {
public:
  static constexpr int probesAcross = 3;
  static constexpr int probes = probesAcross * probesAcross;

  /// The cell whose least column and row these are.
  RimCell(const FocusDepth& focus, std::int64_t column, std::int64_t row)
      : m_buffer(focus.depth), m_column(column), m_row(row) {
    for (std::size_t corner = 0; corner < 4; ++corner)
      if (focus.regions[static_cast<std::size_t>(sample(corner))] == Region::focus) {
        m_isFocus[corner] = true;
        m_depths[corner] = m_buffer.at(sample(corner));
        m_greatest = std::max(m_greatest, m_depths[corner]);
      }
  }

  /// mm on the plane through the target; probes keep off the samples.
  Vec2 probe(int number) const {
    const Vec2 low = m_buffer.position(m_column, m_row);
    const Vec2 high = m_buffer.position(m_column + 1, m_row + 1);
    return low + fraction(number).cwiseProduct(high - low);
  }
  /// What a probe that meets the focus at a depth asks of the samples that are not focus; nothing
  /// (-infinity) where the focus falls away no more steeply than the surface may by itself.
  double asked(int number, double depth) const {
    const Vec2 f = fraction(number);
    const double weights[] = {(1.0 - f.x()) * (1.0 - f.y()), f.x() * (1.0 - f.y()),
                              (1.0 - f.x()) * f.y(), f.x() * f.y()};
    double own = 0.0, weight = 0.0; // of the samples of the focus
    Vec2 middle = Vec2::Zero();
    for (int corner = 0; corner < 4; ++corner)
      if (const auto i = static_cast<std::size_t>(corner); m_isFocus[i]) {
        own += weights[i] * m_depths[i];
        middle += weights[i] * Vec2(corner % 2, corner / 2);
        weight += weights[i];
      }
    const double pitch =
        std::abs(m_buffer.xAxis().coordinate(m_column + 1) - m_buffer.xAxis().coordinate(m_column));
    const double rounding = 1e-3;
    if (depth - own / weight <=
        steepestBoundary * pitch * ((f - middle / weight).norm() + rounding))
      return -infinity;
    return std::min((depth - own) / (1.0 - weight), m_greatest + steepestRim * pitch);
  }
  /// Visits the samples that are not focus.
  template <typename Visitor>
  void visitRim(const Visitor& visit) const {
    for (std::size_t corner = 0; corner < 4; ++corner)
      if (!m_isFocus[corner])
        visit(sample(corner));
  }

private:
  static Vec2 fraction(int number) {
    return (Vec2(number % probesAcross, number / probesAcross).array() + 0.5) / probesAcross;
  }
  std::int64_t sample(std::size_t corner) const {
    const auto at = static_cast<std::int64_t>(corner);
    return m_buffer.sample(m_column + at % 2, m_row + at / 2);
  }

  const DepthBuffer& m_buffer;
  std::int64_t m_column, m_row;
  std::array<bool, 4> m_isFocus{};
  std::array<double, 4> m_depths{};
  double m_greatest = -infinity; ///< of the samples of the focus
};

std::vector<RimCell> rimCells(const FocusDepth& focus) {
  const DepthBuffer& buffer = focus.depth;
  std::vector<RimCell> cells;
  for (std::int64_t row = 0; row + 1 < buffer.rows(); ++row) {
    const Region* const above = &focus.regions[static_cast<std::size_t>(buffer.sample(0, row))];
    const Region* const below = above + buffer.columns();
    const auto inColumn = [&](std::int64_t column) {
      return (above[column] == Region::focus) + (below[column] == Region::focus);
    };
    for (std::int64_t column = 0; column + 1 < buffer.columns(); ++column)
      if (const int count = inColumn(column) + inColumn(column + 1); count > 0 && count < 4)
        cells.emplace_back(focus, column, row);
  }
  return cells;
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

Rim FocusTracer::rim(const FocusDepth& focus) const {
  const std::vector<RimCell> cells = rimCells(focus);
  std::vector<double> met(cells.size() * RimCell::probes, infinity);
  const CellRays cellRays(m_camera, *m_cells);
  const auto meet = [&met](std::int64_t probe, double depth) {
    met[static_cast<std::size_t>(probe)] = depth;
  };
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, cells.size()), [&](const auto& range) {
    FocusBatch batch(*m_cells, meet);
    for (std::size_t i = range.begin(); i < range.end(); ++i)
      for (int probe = 0; probe < RimCell::probes; ++probe) {
        const Vec2 position = cells[i].probe(probe);
        const auto [ray, depthPerLength] = cellRays.through(position);
        const Interval inDomain =
            m_isWhole ? Interval{} : inVolume(m_volume, m_camera.rayThrough(position));
        batch.add(static_cast<std::int64_t>(i) * RimCell::probes + probe, ray, inDomain,
                  depthPerLength);
      }
    batch.trace();
  });

  Rim rim;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    double deepest = -infinity;
    for (int probe = 0; probe < RimCell::probes; ++probe)
      if (const double depth = met[i * RimCell::probes + static_cast<std::size_t>(probe)];
          depth < infinity) {
        deepest = std::max(deepest, cells[i].asked(probe, depth));
        rim.meetings.push_back({cells[i].probe(probe), depth});
      }
    if (deepest > -infinity)
      cells[i].visitRim([&](std::int64_t at) { rim.samples.push_back({at, deepest}); });
  }
  // A sample has the deepest that its cells ask for.
  std::ranges::sort(rim.samples, [](const RimDepth& a, const RimDepth& b) {
    return a.sample < b.sample || (a.sample == b.sample && a.depth > b.depth);
  });
  const auto repeated = std::ranges::unique(rim.samples, {}, &RimDepth::sample);
  rim.samples.erase(repeated.begin(), repeated.end());
  return rim;
}

FocusDepth traceFocus(const Camera& camera, const Domain& volume, const Mask& focus) {
  return FocusTracer(camera, volume, focus).depths();
}

} // namespace fenestra
