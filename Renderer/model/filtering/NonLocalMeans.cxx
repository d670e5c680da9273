#include "model/filtering/NonLocalMeans.h"

#include "base/SimdTargets.h"
#include "model/filtering/PatchTile.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "model/filtering/NonLocalMeans.cxx"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
// After foreach_target.h:
#include "base/Simd-inl.h"
HWY_BEFORE_NAMESPACE();
namespace fenestra::core::HWY_NAMESPACE {
namespace {

/// Squared differences between two rows, summed over three columns.
HWY_INLINE void sumColumns(const float* here, const float* there, std::int64_t count, float* sums) {
  const auto square = [&](std::int64_t x) {
    const Float difference = load(here + x) - load(there + x);
    return difference * difference;
  };
  for (std::int64_t x = 0; x < count; x += static_cast<std::int64_t>(laneCount))
    store(square(x - 1) + square(x) + square(x + 1), sums + x);
}

HWY_INLINE void addRows(const float* a, const float* b, const float* c, std::int64_t count,
                        float* sums) {
  for (std::int64_t x = 0; x < count; x += static_cast<std::int64_t>(laneCount))
    store(load(a + x) + load(b + x) + load(c + x), sums + x);
}

/// Squared patch differences of slice z of the tile, without the sum over slices. `scratch`: room
/// for PatchTile::rows + 2 rows.
HWY_INLINE void sumSlice(const PatchTile& tile, std::int64_t z, std::int64_t offset, float* scratch,
                         float* sums) {
  const Size3& size = tile.size;
  for (std::int64_t y = -1; y <= size.y(); ++y) {
    const float* const here = tile.compared.data() + tile.index(y, z);
    sumColumns(here, here + offset, size.x(), scratch + (y + 1) * PatchTile::columns);
  }
  for (std::int64_t y = 0; y < size.y(); ++y) {
    const float* const first = scratch + y * PatchTile::columns;
    addRows(first, first + PatchTile::columns, first + 2 * PatchTile::columns, size.x(),
            sums + y * PatchTile::columns);
  }
}

/// Adds the voxels at one offset to the sums of a row.
HWY_INLINE void accumulate(const float* below, const float* same, const float* above,
                           const float* here, const float* there, float noise, std::int64_t count,
                           const PatchSums& sums) {
  constexpr float scale = 1.0F / (27.0F * 16.0F);
  const Float allowed(noise);
  for (std::int64_t x = 0; x < count; x += static_cast<std::int64_t>(laneCount)) {
    const Float d2 = (load(below + x) + load(same + x) + load(above + x)) * Float(scale);
    Float weight = max(Float(1.0F) - max(d2 - allowed, Float(0.0F)), Float(0.0F));
    for (int power = 1; power < 16; power *= 2)
      weight = weight * weight;
    store(load(sums.weights + x) + weight, sums.weights + x);
    store(load(sums.changes + x) + weight * (load(there + x) - load(here + x)), sums.changes + x);
    store(max(load(sums.greatest + x), weight), sums.greatest + x);
  }
}

void averagePatches(PatchTile& tile) {
  tile.clearSums();
  for (const Size3& step : tile.steps) {
    const std::int64_t offset = tile.offset(step);
    for (std::int64_t z = -1; z <= tile.size.z(); ++z) {
      sumSlice(tile, z, offset, tile.scratch.data(), tile.slice(z));
      if (z < 1)
        continue;
      for (std::int64_t y = 0; y < tile.size.y(); ++y) {
        const std::int64_t row = y * PatchTile::columns;
        const float* const here = tile.averaged() + tile.index(y, z - 1);
        accumulate(tile.slice(z - 2) + row, tile.slice(z - 1) + row, tile.slice(z) + row, here,
                   here + offset, tile.noise, tile.size.x(), tile.sums(y, z - 1));
      }
    }
  }
}

} // namespace
} // namespace fenestra::core::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace fenestra::core {

HWY_EXPORT(averagePatches);

namespace {

/// Offsets of the voxels that are averaged, without the voxel itself.
std::vector<Size3> listSteps(const Grid& grid) {
  constexpr double wanted = 47.0; // voxels
  const Mat3& axes = grid.indexToWorld.linear();
  const double radius = std::cbrt(0.75 / pi * wanted * std::abs(axes.determinant()));
  std::vector<Size3> steps;
  Size3 step;
  for (step.z() = -PatchTile::reach; step.z() <= PatchTile::reach; ++step.z())
    for (step.y() = -PatchTile::reach; step.y() <= PatchTile::reach; ++step.y())
      for (step.x() = -PatchTile::reach; step.x() <= PatchTile::reach; ++step.x()) {
        const bool isInside = (step.cwiseAbs().array() < grid.size.array()).all();
        const std::int64_t distance = step.cwiseAbs().sum();
        const bool isNear = distance == 1 || (axes * Vec3(step.cast<double>())).norm() <= radius;
        if (distance > 0 && isInside && isNear)
          steps.push_back(step);
      }
  return steps;
}

/// Filters voxels of one type.
template <typename Voxel>
class Filter {
public:
  Filter(const Volume& volume, const LargeArray<Voxel>& voxels, const NonLocalMeans& filter)
      : m_volume(volume),
        m_voxels(voxels),
        m_filter(filter),
        m_unit(filter.isLogarithmic ? volume.maximum - volume.minimum : filter.strength),
        m_out(voxels.size()) {}

  LargeArray<Voxel> run(const StopFlag& stop) && {
    const Size3& size = m_volume.grid.size;
    const Size3 tiles =
        (size + PatchTile::largest() - Size3::Ones()).array() / PatchTile::largest().array();
    const double ratio = m_filter.noise / m_filter.strength;
    tbb::enumerable_thread_specific<PatchTile> workspaces(
        listSteps(m_volume.grid), static_cast<float>(2.0 * ratio * ratio / 16.0),
        m_filter.isLogarithmic);
    tbb::parallel_for(std::int64_t{0}, tiles.prod(), [&](std::int64_t i) {
      if (stop)
        return;
      const Size3 tile(i % tiles.x(), i / tiles.x() % tiles.y(), i / tiles.x() / tiles.y());
      filterTile(tile.cwiseProduct(PatchTile::largest()), workspaces.local());
    });
    return std::move(m_out);
  }

private:
  void filterTile(const Size3& first, PatchTile& tile) {
    tile.size = (m_volume.grid.size - first).cwiseMin(PatchTile::largest());
    const Size3 last = m_volume.grid.size - Size3::Ones();
    for (std::int64_t z = -PatchTile::margin; z < tile.size.z() + PatchTile::margin; ++z)
      for (std::int64_t y = -PatchTile::margin; y < tile.size.y() + PatchTile::margin; ++y) {
        const Size3 row = (first + Size3(0, y, z)).cwiseMax(Size3::Zero()).cwiseMin(last);
        const Voxel* const from = &m_voxels[linearIndex({0, row.y(), row.z()}, m_volume.grid.size)];
        for (std::int64_t x = -PatchTile::margin; x < PatchTile::columns + PatchTile::margin; ++x)
          readVoxel(from[std::clamp(first.x() + x, std::int64_t{0}, last.x())],
                    static_cast<std::size_t>(tile.index(y, z) + x), tile);
      }
    HWY_DYNAMIC_DISPATCH(averagePatches)(tile);
    for (std::int64_t z = 0; z < tile.size.z(); ++z)
      for (std::int64_t y = 0; y < tile.size.y(); ++y) {
        const PatchSums sums = tile.sums(y, z);
        const std::size_t row = linearIndex(first + Size3(0, y, z), m_volume.grid.size);
        for (std::int64_t x = 0; x < tile.size.x(); ++x)
          writeVoxel(row + static_cast<std::size_t>(x), sums.meanChange(x));
      }
  }

  void readVoxel(Voxel voxel, std::size_t at, PatchTile& tile) const {
    const double value = static_cast<double>(voxel) - m_volume.minimum;
    const double compared = m_filter.isLogarithmic ? std::log1p(value) : value;
    tile.compared[at] = static_cast<float>(compared / m_filter.strength);
    if (m_filter.isLogarithmic)
      tile.values[at] = static_cast<float>(value / m_unit);
  }

  void writeVoxel(std::size_t at, float change) {
    double value = static_cast<double>(m_voxels[at]) + m_unit * static_cast<double>(change);
    if constexpr (std::is_integral_v<Voxel>)
      value = std::floor(value + 0.5);
    m_out[at] = static_cast<Voxel>(std::clamp(value, m_volume.minimum, m_volume.maximum));
  }

  const Volume& m_volume;
  const LargeArray<Voxel>& m_voxels;
  const NonLocalMeans& m_filter;
  double m_unit; ///< of averaged numbers, scalar units: squares and sums of floats stay finite
  LargeArray<Voxel> m_out;
};

template <typename Voxel>
LargeArray<Voxel> filterVoxels(const Volume& volume, const LargeArray<Voxel>& voxels,
                               const NonLocalMeans& filter, const StopFlag& stop) {
  return Filter<Voxel>(volume, voxels, filter).run(stop);
}

} // namespace

Volume copyWithoutVoxels(const Volume& volume) {
  return {.grid = volume.grid,
          .voxels = {},
          .name = volume.name,
          .warnings = volume.warnings,
          .modality = volume.modality,
          .hasContrastAgent = volume.hasContrastAgent};
}

Volume applyNonLocalMeans(const Volume& volume, const NonLocalMeans& filter, const StopFlag& stop) {
  constexpr double leastStrength = 1e-12; // of the range: squares of differences stay finite
  const double range = filter.isLogarithmic ? std::log1p(volume.maximum - volume.minimum)
                                            : volume.maximum - volume.minimum;
  if (!(filter.strength > leastStrength * range) || range == 0.0)
    return volume;
  Volume result = copyWithoutVoxels(volume);
  std::visit(
      [&](const auto& voxels) { result.voxels = filterVoxels(volume, voxels, filter, stop); },
      volume.voxels);
  computeRange(result);
  return result;
}

} // namespace fenestra::core
#endif
