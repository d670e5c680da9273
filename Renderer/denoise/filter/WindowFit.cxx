#include "denoise/filter/WindowFit.h"

#include "base/SimdTargets.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstddef>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "denoise/filter/WindowFit.cxx"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
// After foreach_target.h:
#include "denoise/filter/LocalFit-inl.h"
HWY_BEFORE_NAMESPACE();
namespace fenestra::core::HWY_NAMESPACE {
namespace {

/// Ring buffer of the last rows of several planes.
class RowRing {
public:
  RowRing(std::size_t rows, std::size_t planes, std::size_t width)
      : m_rows(rows), m_planes(planes), m_width(width), m_values(rows * planes * width, 0.0F) {}

  float* at(std::int64_t row, std::size_t plane) {
    constexpr std::int64_t offset = 1000; // makes the negative rows above the image positive
    const auto slot = static_cast<std::size_t>(row + offset) % m_rows;
    return &m_values[(slot * m_planes + plane) * m_width];
  }
  std::size_t planes() const { return m_planes; }
  std::size_t width() const { return m_width; }

  /// Sums of the rows of a window, per column.
  HWY_INLINE void sumWindow(std::size_t plane, float* out) {
    static_assert(window == 5);
    const float *a = at(0, plane), *b = at(1, plane), *c = at(2, plane), *d = at(3, plane),
                *e = at(4, plane);
    for (std::size_t x = 0; x < m_width; ++x)
      out[x] = ((a[x] + b[x]) + (c[x] + d[x])) + e[x];
  }

  static constexpr std::size_t window = 5; ///< cells

private:
  std::size_t m_rows, m_planes, m_width;
  std::vector<float> m_values;
};

/// Processes a tile of the image row by row: sums of cells, fits of windows, sums of the fits.
class TileFit {
public:
  static constexpr std::int64_t columns = tileColumns, rows = tileRows;

  TileFit(const FitInput& input, int level, std::int64_t column, std::int64_t row,
          std::vector<Plane>& out)
      : m_input(input),
        m_layout{input.features.size(), input.color.size()},
        m_level(level),
        m_cellSize(std::int64_t{1} << level),
        m_column(column),
        m_row(row),
        m_out(out),
        m_fit(m_layout),
        m_sums(RowRing::window, m_layout.sums(), width),
        m_fits(RowRing::window, m_layout.coefficients(), width),
        m_fitSums(2, m_layout.coefficients(), width),
        m_rowSum(width),
        m_windowSums(m_layout.sums() * width),
        m_interpolated(m_layout.coefficients() * width) {}

  HWY_ATTR void run() {
    // A sum of fits needs fits of two more rows, and a fit needs sums of two more rows.
    // Interpolation between cells needs one more row of fit sums on each side.
    const std::int64_t first = m_row - 1, end = std::min(m_row + rows, cells(m_input.height)) + 1;
    for (std::int64_t row = first - 4; row < end + 4 && !*m_input.stop; ++row) {
      sumCells(row);
      if (row >= first)
        fitRow(row - 2);
      if (row >= first + 4)
        sumFits(row - 4);
      if (row >= first + 5)
        evaluateRows(row - 5);
    }
  }

private:
  static constexpr std::int64_t margin = 5; ///< cells on each side that sums are needed for
  /// >= columns + 2 margin, rounded up; SIMD reads past the last cell
  static constexpr std::size_t width = 80;

  std::int64_t cells(int pixels) const { return (pixels + m_cellSize - 1) / m_cellSize; }

  // ---- sums over cells; index 0 of a row is cell m_column - margin

  HWY_INLINE void sumCells(std::int64_t row) {
    for (std::size_t plane = 0; plane < m_sums.planes(); ++plane)
      std::fill_n(m_sums.at(row, plane), width, 0.0F);
    if (row < 0 || row >= cells(m_input.height))
      return;
    const std::int64_t firstCell = std::max<std::int64_t>(m_column - margin, 0);
    const std::int64_t first = firstCell * m_cellSize;
    const std::int64_t end =
        std::min<std::int64_t>((m_column + columns + margin) * m_cellSize, m_input.width);
    const auto at = static_cast<std::size_t>(firstCell - (m_column - margin));
    const std::int64_t lastRow = std::min<std::int64_t>((row + 1) * m_cellSize, m_input.height);
    const auto add = [&](std::size_t plane, const Plane& a, const Plane& b) {
      m_products.assign(static_cast<std::size_t>(end - first), 0.0F);
      for (std::int64_t y = row * m_cellSize; y < lastRow; ++y) {
        const std::int64_t start = y * m_input.width + first;
        addProducts(a.data() + start, b.data() + start);
      }
      pool(m_sums.at(row, plane) + at);
    };
    add(SumLayout::pixelCount, m_input.active, m_input.active);
    for (std::size_t i = 0; i < m_layout.features; ++i) {
      add(m_layout.feature(i), m_input.features[i], m_input.active);
      for (std::size_t j = i; j < m_layout.features; ++j)
        add(m_layout.product(i, j), m_input.features[i], m_input.features[j]);
      for (std::size_t c = 0; c < m_layout.colors; ++c)
        add(m_layout.featureColor(i, c), m_input.features[i], m_input.color[c]);
    }
    for (std::size_t c = 0; c < m_layout.colors; ++c)
      add(m_layout.color(c), m_input.color[c], m_input.active);
  }
  HWY_INLINE void addProducts(const float* a, const float* b) {
    float* out = m_products.data();
    const std::size_t count = m_products.size();
    for (std::size_t x = 0; x < count; ++x)
      out[x] += a[x] * b[x];
  }
  HWY_INLINE void pool(float* out) {
    const float* in = m_products.data();
    const std::size_t count = m_products.size();
    if (m_cellSize == 1) {
      std::copy_n(in, count, out);
      return;
    }
    for (std::size_t x = 0; x < count; ++x)
      out[x >> m_level] += in[x];
  }

  // ---- fits, 16 windows at once; index 0 of a row is the window around cell m_column - margin + 2

  HWY_INLINE void fitRow(std::int64_t row) {
    for (std::size_t plane = 0; plane < m_sums.planes(); ++plane)
      m_sums.sumWindow(plane, &m_windowSums[plane * width]);
    m_blockSums.resize(m_layout.sums());
    m_blockFits.resize(m_layout.coefficients());
    for (std::size_t x = 0; x + lanes + 4 <= width; x += lanes) {
      float pixels = 0.0F;
      for (std::size_t plane = 0; plane < m_layout.sums(); ++plane) {
        const float* in = &m_windowSums[plane * width + x];
        Lanes& out = m_blockSums[plane];
        forEachLane([&](std::size_t l) {
          out.v[l] = ((in[l] + in[l + 1]) + (in[l + 2] + in[l + 3])) + in[l + 4];
        });
        if (plane == SumLayout::pixelCount)
          for (const float count : out.v)
            pixels += count;
        if (pixels == 0.0F)
          break;
      }
      if (pixels > 0.0F)
        m_fit.solve(m_blockSums.data(), m_blockFits.data());
      else
        std::ranges::fill(m_blockFits, Lanes{});
      for (std::size_t plane = 0; plane < m_layout.coefficients(); ++plane)
        std::copy_n(m_blockFits[plane].v, lanes, m_fits.at(row, plane) + x);
    }
  }

  // ---- sums of the fits of all windows that contain a cell; index 0 of a row is cell m_column - 1

  HWY_INLINE void sumFits(std::int64_t row) {
    for (std::size_t plane = 0; plane < m_fits.planes(); ++plane) {
      m_fits.sumWindow(plane, m_rowSum.data());
      const float* in = m_rowSum.data();
      float* out = m_fitSums.at(row, plane);
      for (std::size_t x = 0; x + 4 < width; ++x)
        out[x] = ((in[x] + in[x + 1]) + (in[x + 2] + in[x + 3])) + in[x + 4];
    }
  }

  // ---- pixels

  /// Evaluates the pixels between the centers of cell rows `row` and `row` + 1, or the pixels of
  /// `row` if cells are single pixels.
  HWY_INLINE void evaluateRows(std::int64_t row) {
    const std::int64_t begin = row * m_cellSize + m_cellSize / 2;
    const std::int64_t end = std::min({begin + m_cellSize, (m_row + rows) * m_cellSize,
                                       static_cast<std::int64_t>(m_input.height)});
    for (std::int64_t y = std::max(begin, m_row * m_cellSize); y < end; ++y) {
      const double cellRow = (static_cast<double>(y) + 0.5) / static_cast<double>(m_cellSize) - 0.5;
      evaluate(y, row, static_cast<float>(cellRow - static_cast<double>(row)));
    }
  }

  HWY_INLINE void evaluate(std::int64_t y, std::int64_t row, float rowFraction) {
    for (std::size_t plane = 0; plane < m_fitSums.planes(); ++plane) {
      const float *upper = m_fitSums.at(row, plane), *lower = m_fitSums.at(row + 1, plane);
      float* interpolated = &m_interpolated[plane * width];
      for (std::size_t x = 0; x < width; ++x)
        interpolated[x] = upper[x] + rowFraction * (lower[x] - upper[x]);
    }
    const std::int64_t first = m_column * m_cellSize;
    const std::int64_t end =
        std::min<std::int64_t>((m_column + columns) * m_cellSize, m_input.width);
    for (std::int64_t phase = 0; phase < m_cellSize; ++phase) {
      // With s = m_cellSize, pixel first - s / 2 + phase + k s lies at fraction (phase + 0.5) / s
      // between the centers of cells m_column - 1 + k and m_column + k. k = 0 may precede the tile.
      const std::int64_t firstK = m_cellSize > 1 && phase < m_cellSize / 2 ? 1 : 0;
      const std::int64_t x = first + firstK * m_cellSize + phase - m_cellSize / 2;
      if (x >= end)
        continue;
      m_count = static_cast<std::size_t>((end - x + m_cellSize - 1) / m_cellSize);
      // If cells are single pixels, the pixel is at the center of the next cell.
      const std::int64_t cell = m_cellSize > 1 ? firstK : 1;
      const float columnFraction =
          m_cellSize > 1 ? (static_cast<float>(phase) + 0.5F) / static_cast<float>(m_cellSize)
                         : 0.0F;
      evaluateStrided(static_cast<std::size_t>(y * m_input.width + x),
                      static_cast<std::size_t>(cell), columnFraction);
    }
  }

  /// Evaluates every m_cellSize-th pixel from `start`. The first lies between indices `cell` and
  /// `cell` + 1 of the fit sums, at fraction `columnFraction`.
  HWY_INLINE void evaluateStrided(std::size_t start, std::size_t cell, float columnFraction) {
    const auto step = static_cast<std::size_t>(m_cellSize);
    for (std::size_t i = 0; i < m_layout.features; ++i)
      for (std::size_t x = 0; x < m_count; ++x)
        m_features[i][x] = m_input.features[i][start + x * step];
    std::array<float, columns + 1> weights, pixels;
    interpolate(SumLayout::pixelCount, cell, columnFraction, weights);
    for (std::size_t c = 0; c < m_layout.colors; ++c) {
      interpolate(m_layout.intercept(c), cell, columnFraction, pixels);
      for (std::size_t i = 0; i < m_layout.features; ++i) {
        const float* f = m_features[i].data();
        const float* slope = &m_interpolated[m_layout.slope(c, i) * width + cell];
        for (std::size_t x = 0; x < m_count; ++x)
          pixels[x] += (slope[x] + columnFraction * (slope[x + 1] - slope[x])) * f[x];
      }
      for (std::size_t x = 0; x < m_count; ++x) {
        const std::size_t at = start + x * step;
        if (m_input.active[at] > 0.0F && weights[x] > 0.0F)
          m_out[c][at] = pixels[x] / weights[x];
      }
    }
  }

  HWY_INLINE void interpolate(std::size_t plane, std::size_t cell, float columnFraction,
                              std::array<float, columns + 1>& out) const {
    const float* in = &m_interpolated[plane * width + cell];
    for (std::size_t x = 0; x < m_count; ++x)
      out[x] = in[x] + columnFraction * (in[x + 1] - in[x]);
  }

  const FitInput& m_input;
  SumLayout m_layout;
  int m_level;
  std::int64_t m_cellSize; ///< pixels along an edge of a cell
  std::int64_t m_column, m_row;
  std::vector<Plane>& m_out;
  LocalFit m_fit;
  RowRing m_sums, m_fits, m_fitSums;
  std::vector<float> m_rowSum, m_windowSums, m_products, m_interpolated;
  std::array<std::array<float, columns + 1>, SumLayout::maxFeatures> m_features;
  std::size_t m_count = 0; ///< pixels that are evaluated together
  std::vector<Lanes> m_blockSums, m_blockFits;
};

void fitTile(const FitInput& input, int level, std::int64_t column, std::int64_t row,
             std::vector<Plane>& out) {
  TileFit(input, level, column, row, out).run();
}

} // namespace
} // namespace fenestra::core::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace fenestra::core {

HWY_EXPORT(fitTile);

std::vector<Plane> fitWindows(const FitInput& input, int level) {
  std::vector<Plane> out = input.color;
  const std::int64_t tileWidth = std::int64_t{tileColumns} << level,
                     tileHeight = std::int64_t{tileRows} << level;
  const std::int64_t columns = (input.width + tileWidth - 1) / tileWidth,
                     rows = (input.height + tileHeight - 1) / tileHeight;
  tbb::parallel_for(std::int64_t{0}, columns * rows, [&](std::int64_t tile) {
    HWY_DYNAMIC_DISPATCH(fitTile)
    (input, level, tile % columns * tileColumns, tile / columns * tileRows, out);
  });
  return out;
}

} // namespace fenestra::core
#endif
