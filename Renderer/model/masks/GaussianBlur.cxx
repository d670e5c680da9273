#include "model/masks/GaussianBlur.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>

namespace fenestra::core {
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

/// Adds weight * from to a row.
void addRow(float weight, const float* from, std::int64_t count, float* to) {
  for (std::int64_t x = 0; x < count; ++x)
    to[x] += weight * from[x];
}

/// A slice of floats. Rows of zeros are marked as empty and not written.
struct Plane {
  std::vector<float> values;
  std::vector<char> isEmpty; ///< per row

  Plane(std::int64_t columns, std::int64_t rows)
      : values(static_cast<std::size_t>(columns * rows)), isEmpty(static_cast<std::size_t>(rows)) {}
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
    std::vector<Plane> ring(static_cast<std::size_t>(ringSize), Plane(m_size.x(), m_size.y()));
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
    for (std::int64_t y = 0; y < m_size.y(); ++y) {
      char& isEmpty = to.isEmpty[static_cast<std::size_t>(y)] = 1;
      float* const row = to.values.data() + y * m_size.x();
      forEachTap(1, [&](std::int64_t k, float weight) {
        const std::int64_t other = std::clamp<std::int64_t>(y + k, 0, m_size.y() - 1);
        addTo(row, isEmpty, raw, other, weight);
      });
    }
  }

  void blurAlongRow(std::int64_t z, std::int64_t y, Plane& to) const {
    const Size3 start(0, clampToMask(1, y), clampToMask(2, z));
    const std::uint8_t* const from = m_mask.voxels.data() + linearIndex(start, m_mask.grid.size);
    const std::int64_t columns = m_mask.grid.size.x(), radius = kernelRadius(0);
    char& isEmpty = to.isEmpty[static_cast<std::size_t>(y)];
    isEmpty = std::all_of(from, from + columns, [](std::uint8_t value) { return value == 0; });
    if (isEmpty)
      return;
    std::vector<float> padded(static_cast<std::size_t>(m_size.x() + 2 * radius));
    const float perMaxValue = 1.0F / static_cast<float>(m_mask.maxValue);
    for (std::int64_t x = 0; x < m_size.x() + 2 * radius; ++x)
      padded[static_cast<std::size_t>(x)] =
          perMaxValue * static_cast<float>(from[clampToMask(0, x - radius)]);
    float* const row = to.values.data() + y * m_size.x();
    std::fill_n(row, m_size.x(), 0.0F);
    forEachTap(0, [&](std::int64_t k, float weight) {
      addRow(weight, padded.data() + radius + k, m_size.x(), row);
    });
  }

  /// Calls visit(offset, weight) for each sample of the kernel of an axis.
  template <typename Visit>
  void forEachTap(std::size_t axis, const Visit& visit) const {
    for (std::int64_t k = -kernelRadius(axis); k <= kernelRadius(axis); ++k)
      visit(k, m_kernels[axis][static_cast<std::size_t>(std::abs(k))]);
  }

  /// Adds a row of a plane to `row`, and clears `row` first if it is marked as empty.
  void addTo(float* row, char& isEmpty, const Plane& from, std::int64_t y, float weight) const {
    if (from.isEmpty[static_cast<std::size_t>(y)])
      return;
    if (isEmpty)
      std::fill_n(row, m_size.x(), 0.0F);
    isEmpty = 0;
    addRow(weight, from.values.data() + y * m_size.x(), m_size.x(), row);
  }

  template <typename PlaneAt>
  void writeRow(const PlaneAt& at, std::int64_t z, std::int64_t y, std::uint8_t* to) const {
    std::vector<float> row(static_cast<std::size_t>(m_size.x()));
    char isEmpty = 1;
    forEachTap(
        2, [&](std::int64_t k, float weight) { addTo(row.data(), isEmpty, at(z + k), y, weight); });
    if (!isEmpty)
      for (std::size_t x = 0; x < row.size(); ++x)
        to[x] = static_cast<std::uint8_t>(std::min(row[x] * 255.0F + 0.5F, 255.0F));
  }

  const Mask& m_mask;
  Size3 m_first, m_size;
  std::array<std::vector<float>, 3> m_kernels;
};

} // namespace

std::vector<std::uint8_t> blurMask(const Mask& mask, const Size3& first, const Size3& size,
                                   const Vec3& sigmas) {
  std::vector<std::uint8_t> result(static_cast<std::size_t>(size.prod()));
  const Blur blur(mask, first, size, sigmas);
  constexpr std::int64_t blockSize = 32; // slices; each block blurs its neighbors again
  const std::int64_t blocks = (size.z() + blockSize - 1) / blockSize;
  tbb::parallel_for(std::int64_t{0}, blocks, [&](std::int64_t block) {
    blur.blurSlices(block * blockSize, std::min((block + 1) * blockSize, size.z()), result.data());
  });
  return result;
}

} // namespace fenestra::core
