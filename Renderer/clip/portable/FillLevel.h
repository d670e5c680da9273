#pragma once
// One level of the multigrid solver in SmoothFill.cxx.

#include "clip/portable/FillAxis.h"
#include "clip/portable/ParallelLoop.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

namespace fenestra::core {

struct RowStencil;
struct SampleRun;

/// Depths over a grid of samples: fixed in the focus, free elsewhere. Stored with a margin of one
/// sample, whose weight in all stencils is 0.
class FillLevel {
public:
  FillLevel(FillAxis x, FillAxis y)
      : m_x(std::move(x)),
        m_y(std::move(y)),
        m_stride(m_x.size() + 2),
        m_depth(m_stride * (m_y.size() + 2), 0.0f),
        m_free(m_depth.size(), 0.0f),
        m_coverage(m_depth.size(), 0.0f) {}

  std::size_t columns() const { return m_x.size(); }
  std::size_t rows() const { return m_y.size(); }
  bool isSmall() const { return std::max(columns(), rows()) <= 8; }
  /// Smallest sample spacing, mm.
  double pitch() const { return std::min(m_x.pitch(), m_y.pitch()); }

  float& depth(std::size_t column, std::size_t row) { return m_depth[index(column, row)]; }
  float depth(std::size_t column, std::size_t row) const { return m_depth[index(column, row)]; }
  bool isFree(std::size_t column, std::size_t row) const { return m_free[index(column, row)] != 0; }
  /// `coverage`: fraction of the sample's area that is focus, 0 to 1; the sample is free if 0.
  void set(std::size_t column, std::size_t row, float depth, float coverage) {
    const std::size_t at = index(column, row);
    m_depth[at] = depth;
    m_coverage[at] = coverage;
    m_free[at] = coverage > 0.0f ? 0.0f : 1.0f;
  }
  /// Reduces the coverage so that the focus ends at the centers of its outermost samples.
  void trimFocus();

  /// Level of half the resolution. A sample is the mean of four, and is focus if any of them is.
  FillLevel coarsen() const;

  /// Extrapolates the boundary's depths by `length`: into the focus with its own slopes, limited to
  /// maxNearSlope, and out of the focus with decaying slopes. Coarser levels need both, since
  /// the focus does not end at the edges of their samples.
  void extendBoundary(double length);

  /// Initializes the free samples by cubic interpolation of the coarser level.
  void prolongate(const FillLevel& coarse, const ParallelLoop& loop);

  /// Performs `steps` Chebyshev iterations for  L L u - 2 L u / length² + u / length⁴ = 0, L the
  /// Laplacian, at the free samples near the boundary. Elsewhere the coarser level is accurate
  /// enough, or u nearly 0.
  void relax(double length, int steps, const ParallelLoop& loop);

private:
  /// Focus sample next to free ones. There, L u = `fixed` + sum of weights * depths of the free
  /// neighbors; `fixed` comes from the sample and its focus neighbors, with limited slope.
  struct BoundarySample {
    std::size_t at;
    float fixed = 0.0f;
    std::array<float, 4> weights{}; ///< per side of the sample
  };

  struct Neighbor {
    std::size_t side, at;
    double distance; ///< mm
    float weight;    ///< in L
  };
  /// Calls function(neighbor) for each neighbor of a sample.
  template <typename Function>
  void forEachNeighbor(std::size_t at, const Function& function) const {
    const std::size_t column = at % m_stride - 1, row = at / m_stride - 1;
    const Stencil x = m_x.stencil(column), y = m_y.stencil(row);
    if (column > 0)
      function(Neighbor{0, at - 1, m_x.spacing(column - 1), x.before});
    if (column + 1 < columns())
      function(Neighbor{1, at + 1, m_x.spacing(column), x.after});
    if (row > 0)
      function(Neighbor{2, at - m_stride, m_y.spacing(row - 1), y.before});
    if (row + 1 < rows())
      function(Neighbor{3, at + m_stride, m_y.spacing(row), y.after});
  }

  /// Offsets in memory to the neighbors on the four sides.
  std::array<std::ptrdiff_t, 4> offsets() const {
    const auto stride = static_cast<std::ptrdiff_t>(m_stride);
    return {-1, 1, -stride, stride};
  }

  /// Mean of the depths extrapolated from the known neighbors.
  float extrapolate(std::size_t at, const std::vector<float>& own,
                    const std::vector<std::uint8_t>& known, double length) const;

  std::size_t index(std::size_t column, std::size_t row) const {
    return (row + 1) * m_stride + column + 1;
  }

  /// Finds the focus samples next to free ones.
  void findBoundary();

  /// Computes m_boundary.
  void computeBoundary();

  /// Largest factor on weights at the boundary; larger values only slow convergence.
  static constexpr float maxStiffness = 3.0f;
  BoundarySample makeBoundarySample(std::size_t at) const;

  /// Computes the Laplacian L u of the depths along `runs` and at the boundary.
  void applyLaplacian(const std::vector<SampleRun>& runs, float* laplacian,
                      const ParallelLoop& loop) const;

  /// One step of the iteration.
  struct ChebyshevStep {
    float momentum, step;
  };
  void updateDepths(const std::vector<SampleRun>& runs, const float* laplacian, float* change,
                    float tension, const ChebyshevStep& by, const ParallelLoop& loop);

  RowStencil rowStencil(const SampleRun& run) const;

  FillAxis m_x, m_y;
  std::size_t m_stride;
  std::vector<float> m_depth;    ///< mm
  std::vector<float> m_free;     ///< 1: free; 0: focus or margin
  std::vector<float> m_coverage; ///< fraction of each sample's area that is focus
  std::vector<BoundarySample> m_boundary;
};

} // namespace fenestra::core
