#include "model/masks/OuterLayer.h"

#include "model/masks/GaussianBlur.h"
#include "model/volume/Field.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <optional>

namespace fenestra::core {
namespace {

constexpr double coarseSpacing = 2.0; ///< mm; approximate spacing of the subsampled grid
constexpr double maxPerVoxel = 8.0;   ///< voxels of the resampled mask per voxel of the volume

/// Subsampled grid: its voxel i has the position of voxel i * `stride` of `fine`.
Grid subsampleGrid(const Grid& fine, const Size3& stride) {
  const Affine& map = fine.indexToWorld;
  return {(fine.size.array() - 1) / stride.array() + 1,
          Affine(map.linear() * Mat3::Diagonal(stride.cast<double>()), map.translation())};
}

/// Axis of the grid closest to the patient's S axis.
int findLongAxis(const Grid& grid) {
  const Vec3 up = grid.indexToWorld.linear().normalizedColumns().row(2).cwiseAbs();
  return static_cast<int>(std::ranges::max_element(up.data(), up.data() + 3) - up.data());
}

/// Flood fill of the air voxels that are connected with the sides of the grid.
class FloodFill {
public:
  FloodFill(const Size3& size, std::vector<std::uint8_t>& voxels)
      : m_size(size), m_voxels(voxels) {}

  void fillFromSides(int longAxis) {
    for (int axis = 0; axis < 3; ++axis)
      if (axis != longAxis) {
        enterSide(axis, 0);
        enterSide(axis, m_size[axis] - 1);
      }
    while (!m_front.empty()) {
      const std::vector<Size3> front = std::exchange(m_front, {});
      for (const Size3& voxel : front)
        for (int axis = 0; axis < 3; ++axis)
          for (const int step : {-1, 1})
            enter(voxel + step * Size3::Unit(axis));
    }
  }

  static constexpr std::uint8_t body = 0, air = 1, outside = 255;

private:
  void enterSide(int axis, std::int64_t at) {
    Size3 first = Size3::Zero(), last = m_size.array() - 1;
    first[axis] = last[axis] = at;
    for (std::int64_t z = first.z(); z <= last.z(); ++z)
      for (std::int64_t y = first.y(); y <= last.y(); ++y)
        for (std::int64_t x = first.x(); x <= last.x(); ++x)
          enter({x, y, z});
  }

  void enter(const Size3& voxel) {
    if ((voxel.array() < 0).any() || (voxel.array() >= m_size.array()).any())
      return;
    std::uint8_t& value = m_voxels[linearIndex(voxel, m_size)];
    if (value != air)
      return;
    value = outside;
    m_front.push_back(voxel);
  }

  Size3 m_size;
  std::vector<std::uint8_t>& m_voxels;
  std::vector<Size3> m_front;
};

/// Mask of the air around the body, at every `stride`-th voxel: 255 or 0.
Mask findOutsideAir(const Volume& volume, double airBelow, const Size3& stride) {
  Mask mask{subsampleGrid(volume.grid, stride), {}, 0, {}, 255};
  const Size3& size = mask.grid.size;
  mask.voxels.resize(static_cast<std::size_t>(size.prod()));
  const auto classify = [&](const auto& voxels) {
    tbb::parallel_for(std::int64_t{0}, size.z(), [&](std::int64_t z) {
      std::uint8_t* to = &mask.voxels[linearIndex({0, 0, z}, size)];
      for (std::int64_t y = 0; y < size.y(); ++y) {
        const Size3 row = Size3(0, y, z).array() * stride.array();
        const auto* const from = &voxels[linearIndex(row, volume.grid.size)];
        for (std::int64_t x = 0; x < size.x(); ++x)
          *to++ = static_cast<double>(from[x * stride.x()]) < airBelow ? FloodFill::air
                                                                       : FloodFill::body;
      }
    });
  };
  std::visit(classify, volume.voxels);
  FloodFill(size, mask.voxels).fillFromSides(findLongAxis(mask.grid));
  for (std::uint8_t& voxel : mask.voxels) {
    voxel = voxel == FloodFill::outside ? mask.maxValue : 0;
    mask.count += voxel > 0;
  }
  return mask;
}

/// Resamples a mask at the voxels of another grid.
class MaskResampler {
public:
  /// `toMask`: from the other grid's index space to the mask's.
  MaskResampler(const Mask& mask, const Affine& toMask)
      : m_mask(mask), m_field(mask.grid, mask.voxels), m_toMask(toMask) {}

  /// Writes a block of voxels, [begin, end), of the other grid.
  void writeBlock(const Size3& begin, const Size3& end, Mask& to) const {
    const std::optional<std::uint8_t> all = findUniformValue(begin, end);
    for (std::int64_t z = begin.z(); z < end.z(); ++z)
      for (std::int64_t y = begin.y(); y < end.y(); ++y) {
        std::uint8_t* voxel = &to.voxels[linearIndex({begin.x(), y, z}, to.grid.size)];
        for (std::int64_t x = begin.x(); x < end.x(); ++x)
          *voxel++ = all ? *all : sample({x, y, z});
      }
  }

private:
  std::uint8_t sample(const Size3& voxel) const {
    return static_cast<std::uint8_t>(0.5 + m_field.value(m_toMask * voxel.cast<double>()));
  }

  /// Common value of all mask voxels that the block depends on; nullopt if they differ.
  std::optional<std::uint8_t> findUniformValue(const Size3& begin, const Size3& end) const {
    const Box block{begin.cast<double>(), (end.array() - 1).cast<double>()};
    Box box = Box::makeEmpty();
    for (int i = 0; i < 8; ++i)
      box.extend(m_toMask * block.corner(i));
    const Vec3 most = (m_mask.grid.size.array() - 1).cast<double>();
    const auto inside = [&](const Vec3& v) { return v.cwiseMax(0.0).cwiseMin(most); };
    const Size3 first = inside(box.lower.array().floor()).cast<std::int64_t>(),
                last = inside(box.upper.array().ceil()).cast<std::int64_t>();
    const std::uint8_t value = m_mask.voxels[linearIndex(first, m_mask.grid.size)];
    for (std::int64_t z = first.z(); z <= last.z(); ++z)
      for (std::int64_t y = first.y(); y <= last.y(); ++y)
        for (std::int64_t x = first.x(); x <= last.x(); ++x)
          if (m_mask.voxels[linearIndex({x, y, z}, m_mask.grid.size)] != value)
            return std::nullopt;
    return value;
  }

  const Mask& m_mask;
  Field<std::uint8_t> m_field;
  Affine m_toMask;
};

} // namespace

Mask findOuterLayer(const Volume& volume, double airBelow, double depth) {
  const Size3 stride = (coarseSpacing * volume.grid.spacing().cwiseInverse())
                           .cwiseMin(volume.grid.size.cast<double>())
                           .cwiseMax(1.0)
                           .cast<std::int64_t>();
  Mask layer = findOutsideAir(volume, airBelow, stride);
  if (layer.count == 0 || layer.count == layer.grid.voxelCount())
    return {};
  // A half-space blurred by a Gaussian falls to 0.1 at 1.2816 sigmas from its face.
  const Vec3 sigmas = ((depth / 1.2816) * layer.grid.spacing().cwiseInverse())
                          .cwiseMin(layer.grid.size.cast<double>());
  layer.voxels = blurMask(layer, Size3::Zero(), layer.grid.size, sigmas);
  // Indicator by blurred value: a ramp around 0.1, which is the blurred value at `depth`.
  std::array<std::uint8_t, 256> remapped;
  for (std::size_t i = 0; i < remapped.size(); ++i) {
    const double indicator = std::clamp((static_cast<double>(i) / 255.0 - 0.05) / 0.1, 0.0, 1.0);
    remapped[i] = static_cast<std::uint8_t>(std::lround(indicator * layer.maxValue));
  }
  for (std::uint8_t& voxel : layer.voxels)
    voxel = remapped[voxel];
  return layer;
}

Mask resampleMask(const Mask& layer, const Grid& labels, const Grid& volume) {
  Box box = Box::makeEmpty();
  for (int i = 0; i < 8; ++i)
    box.extend(labels.worldToIndex * volume.worldCorner(i));
  const Vec3 first = box.lower.array().floor(),
             size3 = box.upper.array().ceil() + 1.0 - first.array();
  Affine indexToWorld = labels.indexToWorld;
  const double most = std::max(0x1p24, maxPerVoxel * static_cast<double>(volume.voxelCount()));
  if (!(size3.prod() <= most))
    return {{Size3::Ones(), indexToWorld}, {0}, 0, {}, layer.maxValue};
  indexToWorld.translate(first);
  Mask mask{{size3.cast<std::int64_t>(), indexToWorld}, {}, 0, {}, layer.maxValue};
  const Size3& size = mask.grid.size;
  mask.voxels.resize(static_cast<std::size_t>(size.prod()));
  const MaskResampler resampler(layer, layer.grid.worldToIndex * indexToWorld);
  constexpr std::int64_t edge = 8; // voxels, of a block
  tbb::parallel_for(std::int64_t{0}, (size.z() + edge - 1) / edge, [&](std::int64_t slab) {
    for (std::int64_t y = 0; y < size.y(); y += edge)
      for (std::int64_t x = 0; x < size.x(); x += edge) {
        const Size3 begin(x, y, edge * slab);
        resampler.writeBlock(begin, (begin.array() + edge).min(size.array()), mask);
      }
  });
  mask.count = std::ranges::count_if(mask.voxels, [&](auto v) { return v >= mask.threshold(); });
  return mask;
}

} // namespace fenestra::core
