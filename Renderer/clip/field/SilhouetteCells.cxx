#include "clip/field/SilhouetteCells.h"

#include "clip/focus/FocusCells.h"
#include "clip/focus/Footprints.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <array>

namespace fenestra::core {

namespace {

/// Per cell of `range`: 1 if any of its four samples is outside the focus, else 0.
std::vector<std::uint8_t> findOuterCells(const FocusDepth& focus, const CellRange& range) {
  std::vector<std::uint8_t> isOuter(range.size());
  const auto outside = [&](std::int64_t sample) {
    return static_cast<std::uint8_t>(focus.regions[static_cast<std::size_t>(sample)] !=
                                     Region::focus);
  };
  for (std::int64_t row = range.top; row < range.bottom; ++row)
    for (std::int64_t column = range.left; column < range.right; ++column) {
      const std::int64_t upper = focus.depth.sample(column, row);
      const std::int64_t lower = upper + focus.depth.columns();
      isOuter[range.at(column, row)] = static_cast<std::uint8_t>(
          outside(upper) | outside(upper + 1) | outside(lower) | outside(lower + 1));
    }
  return isOuter;
}

/// Depth bounds, mm, relative to the target, of the 4 x 4 samples around each cell. The interval is
/// extended away from the camera to twice its length: a pit may be deeper than its samples.
std::vector<SilhouetteCells::DepthBounds> boundNeighborhoods(const DepthBuffer& buffer,
                                                             const CellRange& range) {
  constexpr std::int64_t width = 4;
  constexpr float noDepth = std::numeric_limits<float>::infinity();
  const auto columns = static_cast<std::size_t>(range.columns());
  std::vector<float> row(columns + width - 1);
  // First over four neighbors in a row, then over four such rows.
  std::vector<SilhouetteCells::DepthBounds> bounds(
      columns * static_cast<std::size_t>(range.rows() + width - 1));
  auto bound = bounds.begin();
  for (std::int64_t r = range.top - 1; r < range.bottom + width - 2; ++r) {
    for (std::size_t i = 0; i < row.size(); ++i)
      row[i] = buffer.depthsFromReference()[static_cast<std::size_t>(
          buffer.sample(std::clamp<std::int64_t>(range.left - 1 + static_cast<std::int64_t>(i), 0,
                                                 buffer.columns() - 1),
                        std::clamp<std::int64_t>(r, 0, buffer.rows() - 1)))];
    const auto at = [&](std::size_t i) { // empty for samples outside the focus
      return SilhouetteCells::DepthBounds{row[i], row[i] < noDepth ? row[i] : -noDepth};
    };
    for (std::size_t i = 0; i < columns; ++i)
      *bound++ = enclose(enclose(at(i), at(i + 1)), enclose(at(i + 2), at(i + 3)));
  }
  for (std::size_t i = 0; i < range.size(); ++i) {
    const auto& [least, greatest] =
        enclose(enclose(bounds[i], bounds[i + columns]),
                enclose(bounds[i + 2 * columns], bounds[i + 3 * columns]));
    bounds[i] = {least, 2.0F * greatest - least};
  }
  return bounds;
}

/// True if one of the eight samples around a sample is focus.
bool isBesideFocus(const FocusDepth& focus, std::int64_t column, std::int64_t row) {
  for (const std::int64_t r : {row - 1, row, row + 1})
    for (const std::int64_t c : {column - 1, column, column + 1})
      if (focus.isFocus(c, r))
        return true;
  return false;
}

struct WeightedDepth {
  double depth, weight;
};

/// Ray maxima of the halo, which is sorted by sample, within 2.5 `sigma` samples of a sample, with
/// Gaussian weights. Where `sigma` is large, only some of them, which bounds the time in close
/// views.
std::vector<WeightedDepth> collectMaxima(const std::vector<SilhouetteCells::HaloSample>& halo,
                                         std::int64_t columns, std::int64_t sample, double sigma) {
  const std::int64_t column = sample % columns, row = sample / columns;
  const auto radius = static_cast<std::int64_t>(std::ceil(2.5 * sigma));
  const auto stride = static_cast<std::size_t>(1.0 + sigma / 16.0);
  const auto first = std::ranges::lower_bound(halo, (row - radius) * columns, {},
                                              &SilhouetteCells::HaloSample::sample);
  std::vector<WeightedDepth> found;
  for (auto i = static_cast<std::size_t>(first - halo.begin());
       i < halo.size() && halo[i].sample < (row + radius + 1) * columns; i += stride) {
    const std::int64_t across = halo[i].sample % columns - column;
    const std::int64_t down = halo[i].sample / columns - row;
    const auto squaredDistance = static_cast<double>(across * across + down * down);
    if (std::abs(across) <= radius)
      found.push_back({halo[i].rayMaximum, std::exp(-0.5 * squaredDistance / (sigma * sigma))});
  }
  return found;
}

/// Weighted mean of the depths that differ from their weighted median by at most `limit`, mm.
double averageNearMedian(std::vector<WeightedDepth> depths, double limit) {
  std::ranges::sort(depths, {}, &WeightedDepth::depth);
  double half = 0.0;
  for (const WeightedDepth& at : depths)
    half += 0.5 * at.weight;
  auto middle = depths.begin();
  while (middle + 1 != depths.end() && (half -= middle->weight) > 0.0)
    ++middle;
  double sum = 0.0, weights = 0.0;
  for (const auto& [depth, weight] : depths)
    if (std::abs(depth - middle->depth) <= limit) {
      sum += weight * (depth - middle->depth);
      weights += weight;
    }
  return middle->depth + sum / weights;
}

/// Ray maximum at which the surface begins to leave the interpolated depth for that of the focus,
/// which it has at 1/2: a tenth of a voxel or of the smoothing beside the outline.
constexpr double blendStart = 0.45;

/// Queries that are traced together.
struct QueryBatch {
  std::size_t size = 0;
  std::array<SilhouetteCells::Query*, SilhouetteCells::maxQueries> queries;
  std::array<DepthQuery, SilhouetteCells::maxQueries> requests;
  std::array<DepthHit, SilhouetteCells::maxQueries> results;

  void add(SilhouetteCells::Query& query, const Interval& depths) {
    queries[size] = &query;
    requests[size++] = {query.position, depths};
  }
  std::span<const DepthQuery> depthQueries() const { return std::span(requests).first(size); }
  std::span<DepthHit> hits() { return std::span(results).first(size); }
};

} // namespace

SilhouetteCells::SilhouetteCells(std::shared_ptr<const FocusTracer> tracer, FocusDepth& focus)
    : m_tracer(std::move(tracer)), m_reference(focus.depth.reference()) {
  findCells(focus, {});
  if (const Slots slots = findSlots(focus); !slots.empty()) {
    for (const auto& [sample, limit] : slots) {
      focus.regions[static_cast<std::size_t>(sample)] = Region::context;
      focus.depth.set(sample, infinity);
    }
    findCells(focus, slots);
  }
}

/// Finds the cells and the halo. No hit beyond a slot's limit counts in the cells around it.
void SilhouetteCells::findCells(const FocusDepth& focus, const Slots& slots) {
  m_indices.assign(focus.regions.size(), -1);
  m_depthBounds.clear();
  m_isInner.clear();
  m_halo.clear();
  const Camera& camera = m_tracer->camera();
  const FocusCells& cells = m_tracer->cells();
  const CellRange range = findFocusRange(camera, focus.depth, cells);
  const std::vector<std::uint8_t> isOuter = findOuterCells(focus, range);
  const std::vector<Interval> outer =
      computeDepthBounds(camera, focus.depth, cells, range, isOuter);
  const std::vector<DepthBounds> inner = boundNeighborhoods(focus.depth, range);
  const auto findLimit = [&](std::int64_t column, std::int64_t row) {
    double limit = infinity;
    for (const std::int64_t r : {row, row + 1})
      for (const std::int64_t c : {column, column + 1})
        if (const auto slot = slots.find(focus.depth.sample(c, r)); slot != slots.end())
          limit = std::min(limit, slot->second);
    return limit;
  };
  for (std::int64_t row = range.top; row < range.bottom; ++row)
    for (std::int64_t column = range.left; column < range.right; ++column) {
      const std::size_t cell = range.at(column, row);
      if (isOuter[cell] && outer[cell].isEmpty())
        continue;
      const double limit = slots.empty() ? infinity : findLimit(column, row);
      if (isOuter[cell] && outer[cell].begin > limit)
        continue;
      m_indices[static_cast<std::size_t>(focus.depth.sample(column, row))] =
          static_cast<std::int32_t>(m_depthBounds.size());
      m_depthBounds.push_back(
          isOuter[cell]
              ? DepthBounds{static_cast<float>(outer[cell].begin - m_reference),
                            static_cast<float>(std::min(outer[cell].end, limit) - m_reference)}
              : inner[cell]);
      m_isInner.push_back(!isOuter[cell]);
    }
  findHalo(focus, range);
}

/// Encloses the depth bounds of the four cells around a sample, mm.
Interval SilhouetteCells::joinDepthBounds(const DepthBuffer& buffer, std::int64_t column,
                                          std::int64_t row) const {
  Interval depths{infinity, -infinity};
  for (const std::int64_t r : {std::max<std::int64_t>(row, 1) - 1, row})
    for (const std::int64_t c : {std::max<std::int64_t>(column, 1) - 1, column})
      if (const DepthBounds* const bounds = findDepthBounds(buffer.sample(c, r)))
        depths = enclose(depths, {m_reference + bounds->min, m_reference + bounds->max});
  return depths;
}

void SilhouetteCells::findHalo(const FocusDepth& focus, const CellRange& range) {
  const DepthBuffer& buffer = focus.depth;
  std::vector<DepthQuery> depthQueries;
  for (std::int64_t row = range.top; row <= std::min(range.bottom, buffer.rows() - 1); ++row)
    for (std::int64_t column = range.left; column <= std::min(range.right, buffer.columns() - 1);
         ++column) {
      const std::int64_t sample = buffer.sample(column, row);
      if (focus.regions[static_cast<std::size_t>(sample)] != Region::context ||
          !isBesideFocus(focus, column, row))
        continue;
      const Interval depths = joinDepthBounds(buffer, column, row);
      if (depths.isEmpty())
        continue;
      m_halo.push_back({sample, 0.0, 0.0});
      depthQueries.push_back({buffer.position(column, row), depths});
    }
  std::vector<DepthHit> hits(depthQueries.size());
  tbb::parallel_for(
      tbb::blocked_range<std::size_t>(0, depthQueries.size(), 256), [&](const auto& part) {
        m_tracer->findHitsAndMaxima(std::span(depthQueries).subspan(part.begin(), part.size()),
                                    std::span(hits).subspan(part.begin(), part.size()));
      });
  std::size_t found = 0;
  for (std::size_t i = 0; i < m_halo.size(); ++i)
    if (hits[i].indicator > FocusCells::captureThreshold)
      m_halo[found++] = {m_halo[i].sample, hits[i].depth, hits[i].depth};
  m_halo.resize(found);
  smoothHalo(buffer);
}

double SilhouetteCells::voxelEdge() const {
  const auto toWorld = m_tracer->cells().cellToWorld().linear();
  double edge = 0.0;
  for (int axis = 0; axis < 3; ++axis)
    edge = std::max(edge, (toWorld * Vec3(Vec3::Unit(axis))).norm());
  return edge;
}

/// Around each halo sample: the focus samples that are nearer to it than any focus at its depth, up
/// to a voxel more. There must be such focus within `reach`: else the focus is not only a strip. A
/// strip of one sample is always within reach: where pixels are as large as voxels, slots have no
/// more. The depth of the halo is the deeper of its ray maximum and mean: the mean alone can be
/// that of another part of the focus, and the maximum alone that of a nearer plane of voxels.
SilhouetteCells::Slots SilhouetteCells::findSlots(const FocusDepth& focus) const {
  const DepthBuffer& buffer = focus.depth;
  const double tolerance = voxelEdge(), widest = std::min(voxelEdge(), 2.0); // mm
  constexpr double mostSamples = 48.0; // bounds the time in close views
  const double reach =
      std::clamp(widest / std::abs(buffer.xAxis().pitch), 2.0, mostSamples); // samples
  const auto radius = static_cast<std::int64_t>(reach);
  Slots slots;
  std::vector<std::pair<std::int64_t, std::int64_t>> farther; // squared distance and sample
  for (const HaloSample& halo : m_halo) {
    const std::int64_t column = halo.sample % buffer.columns(),
                       row = halo.sample / buffer.columns();
    const double limit = std::max(halo.rayMaximum, halo.depth) + tolerance;
    std::int64_t nearest = 0; // squared distance of focus at the halo's depth; 0: none
    farther.clear();
    for (std::int64_t y = -radius; y <= radius; ++y)
      for (std::int64_t x = -radius; x <= radius; ++x) {
        const std::int64_t distance = x * x + y * y;
        if (static_cast<double>(distance) > reach * reach || !focus.isFocus(column + x, row + y))
          continue;
        const std::int64_t sample = buffer.sample(column + x, row + y);
        if (buffer.at(sample) > limit)
          farther.emplace_back(distance, sample);
        else if (nearest == 0 || distance < nearest)
          nearest = distance;
      }
    for (const auto& [distance, sample] : farther)
      if (distance < nearest)
        if (double& least = slots.try_emplace(sample, limit).first->second; limit < least)
          least = limit;
  }
  return slots;
}

/// Sets the halo's depths to the mean of its ray maxima along the outline, with Gaussian weights of
/// standard deviation 1.5 times the longest edge of the focus's voxels, at least two samples.
/// Maxima that differ from the weighted median by more than four edges do not count: they belong to
/// other parts of the focus.
void SilhouetteCells::smoothHalo(const DepthBuffer& buffer) {
  const double edge = voxelEdge();
  const double sigma = std::max(1.5 * edge / std::abs(buffer.xAxis().pitch), 2.0);
  tbb::parallel_for(std::size_t{0}, m_halo.size(), [&](std::size_t i) {
    std::vector<WeightedDepth> maxima =
        collectMaxima(m_halo, buffer.columns(), m_halo[i].sample, sigma);
    if (!maxima.empty())
      m_halo[i].depth = averageNearMedian(std::move(maxima), 4.0 * edge);
  });
}

void SilhouetteCells::move(double offset) {
  m_offset += offset;
  for (DepthBounds& bounds : m_depthBounds)
    bounds = {static_cast<float>(bounds.min + offset), static_cast<float>(bounds.max + offset)};
}

void SilhouetteCells::evaluate(std::span<Query> queries) const {
  QueryBatch inner, rest;
  const double toFocus = m_reference - m_offset; // undoes move()
  const auto findBounds = [&](const Query& query) {
    const auto& [least, greatest] = m_depthBounds[static_cast<std::size_t>(query.cell)];
    return Interval{toFocus + least, toFocus + greatest};
  };
  const auto addToRest = [&](Query& query) {
    const Interval bounds = findBounds(query);
    rest.add(query, {bounds.begin, isInner(query.cell) ? infinity : bounds.end});
  };
  for (Query& query : queries) {
    const Interval bounds = findBounds(query);
    const double nearLimit = toFocus + query.nearLimit;
    const bool isBounded = isInner(query.cell) || nearLimit <= bounds.end; // else maybe in a slot
    if (isBounded && m_tracer->isFocus(query.position, nearLimit))
      query.depth = bounds.begin - toFocus; // the hit is at or before nearLimit
    else if (isInner(query.cell))
      inner.add(query, bounds);
    else
      addToRest(query);
  }
  m_tracer->findHits(inner.depthQueries(), inner.hits());
  for (std::size_t i = 0; i < inner.size; ++i)
    if (inner.results[i].indicator > 0.0)
      inner.queries[i]->depth = inner.results[i].depth - toFocus;
    else
      addToRest(*inner.queries[i]);
  m_tracer->findHitsAndMaxima(rest.depthQueries(), rest.hits());
  for (std::size_t i = 0; i < rest.size; ++i)
    if (const DepthHit& hit = rest.results[i]; hit.indicator > blendStart) {
      Query& query = *rest.queries[i];
      const double depth = std::min(hit.depth, findBounds(query).end) - toFocus;
      const double blend = (hit.indicator - blendStart) / (0.5 - blendStart);
      query.depth += blend * (depth - query.depth);
    }
}

} // namespace fenestra::core
