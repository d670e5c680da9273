#include "model/masks/GaussianBlur.h"

#include "base/SimdTargets.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <memory>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "model/masks/GaussianBlur.cxx"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
// After foreach_target.h:
#include "base/Simd-inl.h"

#ifndef FENESTRA_BLUR_TAPS
#define FENESTRA_BLUR_TAPS
namespace fenestra::core {

/// Rows to add, with their weights, in order. Rows and sums have room for complete SIMD vectors.
struct BlurTaps {
  static constexpr std::int64_t padding = 16; ///< floats; at least the lanes of a vector

  std::vector<const float*> rows;
  std::vector<float> weights;
};

} // namespace fenestra::core
#endif

HWY_BEFORE_NAMESPACE();
namespace fenestra::core::HWY_NAMESPACE {
namespace {

static_assert(laneCount <= BlurTaps::padding);

/// Writes the weighted sums of `count` floats.
void addTaps(const BlurTaps& taps, std::int64_t count, float* to) {
  for (std::int64_t x = 0; x < count; x += static_cast<std::int64_t>(laneCount)) {
    Float sum(0.0F);
    for (std::size_t k = 0; k < taps.rows.size(); ++k)
      sum = sum + Float(taps.weights[k]) * load(taps.rows[k] + x);
    store(sum, to + x);
  }
}

} // namespace
} // namespace fenestra::core::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace fenestra::core {

HWY_EXPORT(addTaps);

namespace {

/// Kernel weights from the center outward, w[0] + 2 (w[1] + ...) = 1.
std::vector<float> makeHalfKernel(double sigma) {
  const auto radius = static_cast<int>(std::ceil(3.0 * sigma));
  std::vector<double> weights;
  double sum = 0.0;
  for (int k = 0; k <= radius; ++k) {
    weights.push_back(k == 0 ? 1.0 : std::exp(-0.5 * k * k / (sigma * sigma)));
    sum += k == 0 ? weights.back() : 2.0 * weights.back();
  }
  std::vector<float> kernel;
  for (const double weight : weights)
    kernel.push_back(static_cast<float>(weight / sum));
  return kernel;
}

/// A slice of floats. Rows of zeros are marked as empty and not written: their memory is not used.
struct Plane {
  std::int64_t stride; ///< between rows
  std::unique_ptr<float[]> values;
  std::vector<char> isEmpty; ///< per row

  Plane(std::int64_t columns, std::int64_t rows)
      : stride((columns + BlurTaps::padding - 1) / BlurTaps::padding * BlurTaps::padding),
        values(new float[static_cast<std::size_t>(stride * rows)]),
        isEmpty(static_cast<std::size_t>(rows)) {}

  float* row(std::int64_t y) { return values.get() + stride * y; }
  const float* row(std::int64_t y) const { return values.get() + stride * y; }
};

class Blur {
public:
  Blur(const Mask& mask, const Size3& first, const Size3& size, const Vec3& sigmas)
      : m_mask(mask),
        m_first(first),
        m_size(size),
        m_kernels{makeHalfKernel(sigmas[0]), makeHalfKernel(sigmas[1]), makeHalfKernel(sigmas[2])} {
  }

  /// Blurs the slices [begin, end) into `to`, the voxels of the complete region. A ring buffer
  /// holds the neighboring slices that each of them needs.
  void blurSlices(std::int64_t begin, std::int64_t end, std::uint8_t* to) const {
    const std::int64_t radius = kernelRadius(2), ringSize = 2 * radius + 1;
    std::vector<Plane> ring;
    for (std::int64_t i = 0; i < ringSize; ++i)
      ring.emplace_back(m_size.x(), m_size.y());
    Plane raw(m_size.x(), m_size.y());
    const auto at = [&](std::int64_t z) -> Plane& {
      return ring[static_cast<std::size_t>((z + ringSize) % ringSize)];
    };
    for (std::int64_t z = begin - radius; z < end + radius; ++z) {
      blurSlice(z, raw, at(z));
      const std::int64_t done = z - radius;
      if (done >= begin)
        for (std::int64_t y = 0; y < m_size.y(); ++y)
          writeRow(at, done, y, to + (done * m_size.y() + y) * m_size.x());
    }
  }

private:
  std::int64_t kernelRadius(std::size_t axis) const {
    return static_cast<std::int64_t>(m_kernels[axis].size()) - 1;
  }

  /// Maps a coordinate in the region to the nearest one in the mask's grid.
  std::int64_t clampToMask(int axis, std::int64_t coordinate) const {
    return std::clamp<std::int64_t>(m_first[axis] + coordinate, 0, m_mask.grid.size[axis] - 1);
  }

  /// Blurs slice z of the region along rows and columns; `raw`: buffer for the row pass.
  void blurSlice(std::int64_t z, Plane& raw, Plane& to) const {
    for (std::int64_t y = 0; y < m_size.y(); ++y)
      blurAlongRow(z, y, raw);
    for (std::int64_t y = 0; y < m_size.y(); ++y)
      to.isEmpty[static_cast<std::size_t>(y)] =
          !addRows(1, to.row(y), [&](std::int64_t k) -> const float* {
            const std::int64_t other = std::clamp<std::int64_t>(y + k, 0, m_size.y() - 1);
            return findRow(raw, other);
          });
  }

  void blurAlongRow(std::int64_t z, std::int64_t y, Plane& to) const {
    const Size3 start(0, clampToMask(1, y), clampToMask(2, z));
    const std::uint8_t* const from = m_mask.voxels.data() + linearIndex(start, m_mask.grid.size);
    const std::int64_t columns = m_mask.grid.size.x(), radius = kernelRadius(0);
    char& isEmpty = to.isEmpty[static_cast<std::size_t>(y)];
    isEmpty = std::all_of(from, from + columns, [](std::uint8_t value) { return value == 0; });
    if (isEmpty)
      return;
    std::vector<float> padded(
        static_cast<std::size_t>(m_size.x() + 2 * radius + BlurTaps::padding));
    const float perMaxValue = 1.0F / static_cast<float>(m_mask.maxValue);
    for (std::int64_t x = 0; x < m_size.x() + 2 * radius; ++x)
      padded[static_cast<std::size_t>(x)] =
          perMaxValue * static_cast<float>(from[clampToMask(0, x - radius)]);
    addRows(0, to.row(y), [&](std::int64_t k) { return padded.data() + radius + k; });
  }

  /// A row of a plane; null if it is empty.
  static const float* findRow(const Plane& plane, std::int64_t y) {
    return plane.isEmpty[static_cast<std::size_t>(y)] ? nullptr : plane.row(y);
  }

  /// Convolves along an axis: the row at offset k is rowAt(k), or zero if null. Returns false, and
  /// writes nothing, if all rows are zero.
  template <typename RowAt>
  bool addRows(std::size_t axis, float* to, const RowAt& rowAt) const {
    BlurTaps taps;
    for (std::int64_t k = -kernelRadius(axis); k <= kernelRadius(axis); ++k)
      if (const float* const row = rowAt(k)) {
        taps.rows.push_back(row);
        taps.weights.push_back(m_kernels[axis][static_cast<std::size_t>(std::abs(k))]);
      }
    if (taps.rows.empty())
      return false;
    HWY_DYNAMIC_DISPATCH(addTaps)(taps, m_size.x(), to);
    return true;
  }

  template <typename PlaneAt>
  void writeRow(const PlaneAt& at, std::int64_t z, std::int64_t y, std::uint8_t* to) const {
    std::vector<float> row(static_cast<std::size_t>(m_size.x() + BlurTaps::padding));
    if (addRows(2, row.data(), [&](std::int64_t k) { return findRow(at(z + k), y); }))
      for (std::int64_t x = 0; x < m_size.x(); ++x)
        to[x] = static_cast<std::uint8_t>(
            std::min(row[static_cast<std::size_t>(x)] * 255.0F + 0.5F, 255.0F));
  }

  const Mask& m_mask;
  Size3 m_first, m_size;
  std::array<std::vector<float>, 3> m_kernels;
};

} // namespace

std::vector<std::uint8_t> blurMask(const Mask& mask, const Size3& first, const Size3& size,
                                   const Vec3& sigmas) {
  std::vector<std::uint8_t> result(static_cast<std::size_t>(size.prod()));
  blurMask(mask, first, size, sigmas, result.data());
  return result;
}

void blurMask(const Mask& mask, const Size3& first, const Size3& size, const Vec3& sigmas,
              std::uint8_t* to) {
  const Blur blur(mask, first, size, sigmas);
  constexpr std::int64_t blockSize = 64; // slices; each block blurs its neighbors again
  const std::int64_t blocks = (size.z() + blockSize - 1) / blockSize;
  tbb::parallel_for(std::int64_t{0}, blocks, [&](std::int64_t block) {
    blur.blurSlices(block * blockSize, std::min((block + 1) * blockSize, size.z()), to);
  });
}

} // namespace fenestra::core
#endif
