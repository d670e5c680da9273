#include "model/medium/LabelWeights.h"

#include "model/medium/PackedMask.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <optional>

namespace fenestra::core {
namespace {

/// A number per voxel of a brick, in 255ths: integers, so that sums do not depend on the order.
using BrickValues = std::array<float, LabelWeights::voxelsInBrick>;
constexpr float maxWeight = 255.0F;

/// Voxels of a brick along an axis, and the number of its rows.
constexpr std::int64_t width = LabelWeights::brickEdge + 1, rowsInBrick = width * width;

/// A part in the combined grid.
struct PlacedPart {
  PackedMask mask;
  int priority;
  std::uint8_t component;
  Size3 first, end; ///< voxels of the combined grid
};

/// Parts in the grid of the first one, which may extend beyond it on all sides.
std::vector<PlacedPart> placeParts(std::size_t count,
                                   const std::function<LabelWeights::Part(std::size_t)>& getPart) {
  std::vector<PlacedPart> all;
  for (std::size_t i = 0; i < count; ++i) {
    const LabelWeights::Part part = getPart(i);
    const Grid& reference = all.empty() ? part.mask.grid : all.front().mask.grid();
    const Vec3 origin = reference.worldToIndex * part.mask.grid.indexToWorld.translation();
    const Size3 first = origin.array().round().cast<std::int64_t>();
    all.push_back(
        {PackedMask(part.mask), part.priority, part.component, first, first + part.mask.grid.size});
  }
  return all;
}

/// How much of a brick a part covers.
enum class Coverage { none, some, all };

/// Indicators of a part in a row of bricks along x.
class PartRows {
public:
  PartRows(const PlacedPart& part, const Size3& grid)
      : m_part(part), m_last(grid.array() - 1), m_stride(grid.x() + padding) {
    m_voxels.resize(static_cast<std::size_t>(m_stride * rowsInBrick));
  }

  int priority() const { return m_part.priority; }
  std::uint8_t component() const { return m_part.component; }

  /// Loads the row of bricks whose first voxels have these y and z.
  void loadRow(std::int64_t y, std::int64_t z) {
    if (m_hasVoxels)
      std::ranges::fill(m_voxels, std::uint8_t{0});
    m_hasVoxels = false;
    std::uint8_t* row = m_voxels.data();
    for (std::int64_t k = 0; k < width; ++k)
      for (std::int64_t j = 0; j < width; ++j, row += m_stride)
        loadVoxels(std::min(y + j, m_last.y()), std::min(z + k, m_last.z()), row);
  }

  /// Reads the brick whose first voxel has this x; `values` are not written for Coverage::none.
  Coverage readBrick(std::int64_t x, BrickValues& values) const {
    if (!m_hasVoxels || x >= m_part.end.x() || x + width <= m_part.first.x())
      return Coverage::none;
    const std::uint8_t* row = m_voxels.data() + x;
    std::uint64_t some = 0, all = ~some; // of the eight voxels from x on; padding repeats the last
    for (std::int64_t i = 0; i < rowsInBrick; ++i) {
      std::uint64_t eight;
      std::memcpy(&eight, row + i * m_stride, sizeof eight);
      some |= eight;
      all &= eight;
    }
    if (some == 0)
      return Coverage::none;
    if (all == ~std::uint64_t{0} && m_part.mask.maxValue() == maxWeight) {
      values.fill(maxWeight);
      return Coverage::all;
    }
    const float scale = maxWeight / static_cast<float>(m_part.mask.maxValue());
    float* to = values.data();
    bool hasAny = false;
    for (std::int64_t i = 0; i < rowsInBrick; ++i, row += m_stride)
      for (std::int64_t k = 0; k < width; ++k, ++to) {
        *to = scale * static_cast<float>(row[k]);
        hasAny = hasAny || row[k] > 0;
      }
    return hasAny ? Coverage::some : Coverage::none;
  }

private:
  static constexpr std::int64_t padding = 8;

  void loadVoxels(std::int64_t y, std::int64_t z, std::uint8_t* row) {
    const Size3 at(0, y - m_part.first.y(), z - m_part.first.z());
    const Size3& size = m_part.mask.grid().size;
    if (at.minCoeff() < 0 || at.y() >= size.y() || at.z() >= size.z() ||
        !m_part.mask.unpackRow(at.y(), at.z(), row + m_part.first.x()))
      return;
    m_hasVoxels = true;
    std::fill_n(row + m_last.x() + 1, padding - 1, row[m_last.x()]);
  }

  const PlacedPart& m_part;
  Size3 m_last;
  std::int64_t m_stride;
  std::vector<std::uint8_t> m_voxels; ///< x fastest, then y, then z
  bool m_hasVoxels = false;
};

/// Label weights of a brick's components, sorted by component, each once.
class BrickWeights {
public:
  /// Computes the weights of the brick whose first voxel has this x; `parts`: by priority.
  void compute(const std::vector<PartRows>& parts, std::int64_t x) {
    m_weights.clear();
    m_rest.fill(maxWeight);
    for (auto p = parts.begin(); p != parts.end() && hasRest();) {
      m_parts.clear();
      const int priority = p->priority();
      Coverage cover = Coverage::none;
      for (; p != parts.end() && p->priority() == priority; ++p) {
        BrickValues values;
        const Coverage one = p->readBrick(x, values);
        if (one != Coverage::none) {
          m_parts.push_back({p->component(), values});
          cover = one;
        }
      }
      if (m_weights.empty() && m_parts.size() == 1 && cover == Coverage::all) {
        m_weights.swap(m_parts);
        return;
      }
      if (!m_parts.empty())
        distributeRest();
    }
    if (hasRest())
      add(0, m_rest);
    std::ranges::sort(m_weights, {}, &Component::component);
  }

  /// The only component of the brick; nullopt if there are several.
  std::optional<std::uint8_t> pureComponent() const {
    return m_weights.size() == 1 ? std::optional(m_weights.front().component) : std::nullopt;
  }
  std::size_t planeCount() const { return m_weights.size() - 1; }
  /// Writes planeCount() planes.
  void write(LabelWeights::Plane* planes) const {
    for (std::size_t c = 0; c < planeCount(); ++c) {
      planes[c].component = m_weights[c].component;
      planes[c].rest = m_weights.back().component;
      planes[c].isLast = c + 1 == planeCount();
    }
    for (std::size_t voxel = 0; voxel < LabelWeights::voxelsInBrick; ++voxel)
      writeVoxel(voxel, planes);
  }

private:
  struct Component {
    std::uint8_t component;
    BrickValues weight;
  };

  bool hasRest() const {
    return std::ranges::any_of(m_rest, [](float left) { return left > 0.0F; });
  }

  void add(std::uint8_t component, const BrickValues& weight) {
    const auto found = std::ranges::find(m_weights, component, &Component::component);
    if (found == m_weights.end()) {
      m_weights.push_back({component, weight});
      return;
    }
    for (std::size_t i = 0; i < weight.size(); ++i)
      found->weight[i] += weight[i];
  }

  /// Distributes the remaining weight among the parts of one priority.
  void distributeRest() {
    BrickValues factor;
    for (std::size_t i = 0; i < factor.size(); ++i) {
      float sum = 0.0F;
      for (const Component& part : m_parts)
        sum += part.weight[i];
      factor[i] = sum > m_rest[i] ? m_rest[i] / sum : 1.0F;
      m_rest[i] -= std::min(sum, m_rest[i]);
    }
    for (Component& part : m_parts) {
      for (std::size_t i = 0; i < factor.size(); ++i)
        part.weight[i] *= factor[i];
      add(part.component, part.weight);
    }
  }

  /// Rounds the weights of a voxel. The largest one (the first, if several are equal) absorbs the
  /// rounding error, so that the sum is exact.
  void writeVoxel(std::size_t voxel, LabelWeights::Plane* planes) const {
    int left = static_cast<int>(maxWeight);
    std::size_t greatest = 0;
    for (std::size_t c = 0; c < m_weights.size(); ++c) {
      const int weight = static_cast<int>(std::lround(m_weights[c].weight[voxel]));
      left -= weight;
      if (c < planeCount())
        planes[c].weights[voxel] = static_cast<std::uint8_t>(weight);
      if (m_weights[c].weight[voxel] > m_weights[greatest].weight[voxel])
        greatest = c;
    }
    if (greatest < planeCount())
      planes[greatest].weights[voxel] =
          static_cast<std::uint8_t>(planes[greatest].weights[voxel] + left);
  }

  BrickValues m_rest;
  std::vector<Component> m_parts, m_weights;
};

} // namespace

LabelWeights::LabelWeights(std::size_t count, const std::function<Part(std::size_t)>& getPart) {
  std::vector<PlacedPart> parts = placeParts(count, getPart);
  Size3 first = parts.front().first, end = parts.front().end;
  for (const PlacedPart& part : parts) {
    first = first.cwiseMin(part.first);
    end = end.cwiseMax(part.end);
  }
  Affine indexToWorld = parts.front().mask.grid().indexToWorld;
  indexToWorld.translate(first.cast<double>());
  for (PlacedPart& part : parts) {
    part.first -= first;
    part.end -= first;
  }
  std::ranges::stable_sort(parts, std::greater{}, &PlacedPart::priority);
  m_grid = Grid(end - first, indexToWorld);
  m_brickCount = ((m_grid.size.array() - 1).max(1) + brickEdge - 1) / brickEdge;
  m_bricks.resize(static_cast<std::size_t>(m_brickCount.prod()));

  std::vector<std::vector<Plane>> layers(static_cast<std::size_t>(m_brickCount.z()));
  tbb::parallel_for(std::int64_t{0}, m_brickCount.z(), [&](std::int64_t z) {
    std::vector<Plane>& planes = layers[static_cast<std::size_t>(z)];
    BrickWeights weights;
    std::vector<PartRows> rows;
    for (const PlacedPart& part : parts)
      if (part.first.z() < brickEdge * z + width && part.end.z() > brickEdge * z)
        rows.emplace_back(part, m_grid.size);
    for (std::int64_t y = 0; y < m_brickCount.y(); ++y) {
      for (PartRows& part : rows)
        part.loadRow(brickEdge * y, brickEdge * z);
      for (std::int64_t x = 0; x < m_brickCount.x(); ++x) {
        weights.compute(rows, brickEdge * x);
        std::int32_t& code = m_bricks[linearIndex(Size3(x, y, z), m_brickCount)];
        if (const std::optional<std::uint8_t> pure = weights.pureComponent()) {
          code = *pure;
          continue;
        }
        const std::size_t before = planes.size();
        code = ~static_cast<std::int32_t>(before);
        planes.resize(before + weights.planeCount());
        weights.write(&planes[before]);
      }
    }
  });
  // Join the layers. So far, codes count planes from the first plane of their own layer.
  std::size_t all = 0;
  for (const std::vector<Plane>& planes : layers)
    all += planes.size();
  m_planes.reserve(all);
  std::int64_t next = 0;
  for (std::int64_t z = 0; z < m_brickCount.z(); ++z) {
    const std::vector<Plane> planes = std::move(layers[static_cast<std::size_t>(z)]);
    const auto layersBefore = static_cast<std::int32_t>(m_planes.size());
    m_planes.insert(m_planes.end(), planes.begin(), planes.end());
    for (std::int64_t i = 0; i < m_brickCount.x() * m_brickCount.y(); ++i, ++next)
      if (std::int32_t& code = m_bricks[static_cast<std::size_t>(next)]; code < 0)
        code -= layersBefore;
  }
}

double LabelWeights::pureFraction() const {
  return static_cast<double>(std::ranges::count_if(m_bricks, [](auto code) { return code >= 0; })) /
         static_cast<double>(m_bricks.size());
}

} // namespace fenestra::core
