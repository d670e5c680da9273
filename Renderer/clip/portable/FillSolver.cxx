// Iterative solver of FillLevel's equations.
#include "clip/portable/FillLevel.h"

#include <memory>

namespace fenestra::core {

/// Samples [begin, end) of a row.
struct SampleRun {
  std::size_t row, begin, end;
};

/// Stencil of L (the Laplacian) along a row.
struct RowStencil {
  const float *before, *after;
  Stencil y;
  std::size_t count;
  std::ptrdiff_t stride;

  float operator()(const float* in, std::size_t i) const {
    const float* const at = in + i;
    return before[i] * (at[-1] - at[0]) + after[i] * (at[1] - at[0]) +
           y.before * (at[-stride] - at[0]) + y.after * (at[stride] - at[0]);
  }
};

namespace {

/// Square tiles of the sample grid, which can be marked.
class SampleTiles {
public:
  SampleTiles(std::size_t columns, std::size_t rows)
      : m_columns(columns),
        m_rows(rows),
        m_across((columns + edge - 1) / edge),
        m_marks(m_across * ((rows + edge - 1) / edge), 0) {}

  /// Marks the sample's tile and the tiles around it.
  void markNeighborhood(std::size_t column, std::size_t row) {
    const std::size_t x = column / edge, y = row / edge;
    for (std::size_t j = y > 0 ? y - 1 : 0; j < std::min(y + 2, m_marks.size() / m_across); ++j)
      for (std::size_t i = x > 0 ? x - 1 : 0; i < std::min(x + 2, m_across); ++i)
        m_marks[j * m_across + i] = 1;
  }

  /// Runs of samples in marked tiles, extended by `margin` samples, 0 or 1.
  std::vector<SampleRun> runs(std::size_t margin) const {
    std::vector<SampleRun> runs;
    for (std::size_t row = 0; row < m_rows; ++row) {
      const std::size_t above = (row - std::min(row, margin)) / edge;
      const std::size_t below = std::min(row + margin, m_rows - 1) / edge;
      const auto isMarked = [&](std::size_t tile) {
        return (m_marks[above * m_across + tile] | m_marks[row / edge * m_across + tile] |
                m_marks[below * m_across + tile]) != 0;
      };
      for (std::size_t tile = 0; tile < m_across; ++tile)
        if (isMarked(tile)) {
          const std::size_t begin = tile * edge - std::min(tile * edge, margin);
          const std::size_t end = std::min((tile + 1) * edge + margin, m_columns);
          if (!runs.empty() && runs.back().row == row && runs.back().end >= begin)
            runs.back().end = end;
          else
            runs.push_back({row, begin, end});
        }
    }
    return runs;
  }

private:
  static constexpr std::size_t edge = 16; ///< samples; farther away the finest levels do not change

  std::size_t m_columns, m_rows, m_across;
  std::vector<std::uint8_t> m_marks;
};

void applyLaplacianRow(const RowStencil& l, const float* in, float* __restrict out) {
  for (std::size_t i = 0; i < l.count; ++i)
    out[i] = l(in, i);
}

/// One step of the iteration along a row: updates the depths u from their Laplacian L u.
void updateRow(const RowStencil& l, const float* laplacian, const float* free, float tension,
               float mass, float momentum, float step, float* __restrict change,
               float* __restrict depth) {
  for (std::size_t i = 0; i < l.count; ++i) {
    const float force = tension * laplacian[i] - l(laplacian, i) - mass * depth[i];
    change[i] = momentum * change[i] + free[i] * step * force;
    depth[i] += change[i];
  }
}

/// Calls function(run) for each run, in parallel, in chunks of several short runs.
template <typename Function>
void forEachRun(const std::vector<SampleRun>& runs, const ParallelLoop& loop,
                const Function& function) {
  loop(runs.size(), 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i != end; ++i)
      function(runs[i]);
  });
}

} // namespace

void FillLevel::applyLaplacian(const std::vector<SampleRun>& runs, float* laplacian,
                               const ParallelLoop& loop) const {
  const std::array<std::ptrdiff_t, 4> offsets = this->offsets();
  forEachRun(runs, loop, [&](const SampleRun& run) {
    const std::size_t first = index(run.begin, run.row);
    applyLaplacianRow(rowStencil(run), &m_depth[first], laplacian + first);
  });
  for (const BoundarySample& sample : m_boundary) {
    const float* const depth = &m_depth[sample.at];
    laplacian[sample.at] = sample.fixed;
    for (std::size_t side = 0; side < 4; ++side)
      laplacian[sample.at] += sample.weights[side] * depth[offsets[side]];
  }
}

void FillLevel::updateDepths(const std::vector<SampleRun>& runs, const float* laplacian,
                             float* change, float tension, const ChebyshevStep& by,
                             const ParallelLoop& loop) {
  forEachRun(runs, loop, [&](const SampleRun& run) {
    const std::size_t first = index(run.begin, run.row);
    updateRow(rowStencil(run), laplacian + first, &m_free[first], tension,
              0.25f * tension * tension, by.momentum, by.step, change + first, &m_depth[first]);
  });
}

RowStencil FillLevel::rowStencil(const SampleRun& run) const {
  return {m_x.before() + run.begin, m_x.after() + run.begin, m_y.stencil(run.row),
          run.end - run.begin, static_cast<std::ptrdiff_t>(m_stride)};
}

void FillLevel::relax(double length, int steps, const ParallelLoop& loop) {
  computeBoundary();
  SampleTiles tiles(columns(), rows());
  for (const BoundarySample& sample : m_boundary)
    tiles.markNeighborhood(sample.at % m_stride - 1, sample.at / m_stride - 1);
  const std::vector<SampleRun> updatedRuns = tiles.runs(0), laplacianRuns = tiles.runs(1);
  const double tension = 2.0 / (length * length);
  const double maxWeightSum = 2.0 * (m_x.maxWeightSum() + m_y.maxWeightSum());
  const double high = maxStiffness * (maxWeightSum + 0.5 * tension) *
                      (maxWeightSum + 0.5 * tension); // bounds the operator's eigenvalues
  const double low = high / (0.25 * steps * steps);   // lowest that the steps damp well
  const double center = 0.5 * (high + low), radius = 0.5 * (high - low);
  // Uninitialized, since only samples near the boundary are accessed.
  const std::unique_ptr<float[]> laplacian(new float[m_depth.size()]);
  const std::unique_ptr<float[]> change(new float[m_depth.size()]);
  for (const SampleRun& run : laplacianRuns) // stencils read one sample further
    for (const std::size_t row : {run.row, run.row + 1, run.row + 2}) {
      const std::size_t first = row * m_stride + run.begin;
      std::fill_n(&laplacian[first], run.end - run.begin + 2, 0.0f);
      std::fill_n(&change[first], run.end - run.begin + 2, 0.0f);
    }
  // Chebyshev iteration (Saad 2003, algorithm 12.1, whose rho this is).
  double rho = radius / center;
  double momentum = 0.0, step = 1.0 / center;
  for (int i = 0; i < steps; ++i) {
    applyLaplacian(laplacianRuns, laplacian.get(), loop);
    updateDepths(updatedRuns, laplacian.get(), change.get(), static_cast<float>(tension),
                 {static_cast<float>(momentum), static_cast<float>(step)}, loop);
    const double next = 1.0 / (2.0 * center / radius - rho);
    momentum = next * rho;
    step = 2.0 * next / radius;
    rho = next;
  }
}

} // namespace fenestra::core
