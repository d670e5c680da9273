// Divides the voxels of label maps.

#include "files/segments/SegmentationReader.h"

#include <tbb/parallel_for.h>

namespace fenestra::core {
namespace {

/// Each voxel becomes 2x2x2 with its labels; `layers` labels per voxel.
template <typename Array>
Array divide(const Array& labels, const Size3& size, std::size_t layers) {
  Array divided(8 * labels.size());
  const Size3 fine = 2 * size;
  tbb::parallel_for(std::int64_t{0}, fine.z(), [&](std::int64_t z) {
    auto to = divided.begin() + static_cast<std::ptrdiff_t>(linearIndex({0, 0, z}, fine) * layers);
    for (std::int64_t y = 0; y < fine.y(); ++y) {
      auto from = labels.begin() +
                  static_cast<std::ptrdiff_t>(linearIndex({0, y / 2, z / 2}, size) * layers);
      for (std::int64_t x = 0; x < size.x(); ++x, from += static_cast<std::ptrdiff_t>(layers))
        for (int half = 0; half < 2; ++half)
          to = std::copy_n(from, layers, to);
    }
  });
  return divided;
}

} // namespace

void Segmentation::divideVoxels() {
  for (LabelMap& map : m_maps) {
    map.labels = std::visit(
        [&](const auto& labels) { return Labels(divide(labels, map.grid.size, map.layerCount)); },
        map.labels);
    const Affine& coarse = map.grid.indexToWorld;
    const Mat3 steps = coarse.linear() * Mat3::Diagonal(Vec3::Constant(0.5));
    map.grid = Grid(2 * map.grid.size, Affine(steps, coarse * Vec3::Constant(-0.25)));
    map.nativeVoxels = 2.0 * map.nativeVoxels;
  }
}

} // namespace fenestra::core
