#pragma once
// One resolution of SmoothFill's multigrid. For SmoothFill.cxx.

#include "clip/surface/FillAxis.h"
#include "clip/surface/SampleTiles.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace fenestra {

struct RowStencil;

/// Depths over a grid of samples, some of them free. A margin of one sample surrounds the stored
/// rows; stencils give it weight 0.
class FillLevel {
public:
  FillLevel(FillAxis x, FillAxis y)
      : m_x(std::move(x)),
        m_y(std::move(y)),
        m_stride(m_x.size() + 2),
        m_depth(m_stride * (m_y.size() + 2), 0.0f),
        m_free(m_depth.size(), 0.0f),
        m_covered(m_depth.size(), 0.0f) {}

  std::size_t columns() const { return m_x.size(); }
  std::size_t rows() const { return m_y.size(); }
  bool isSmall() const { return std::max(columns(), rows()) <= 8; }
  /// True if `solve` takes little time and memory.
  bool isSolvable() const { return columns() * rows() <= 8192; }
  /// Least distance of samples, mm.
  double pitch() const { return 1.0 / std::sqrt(0.5 * std::max(m_x.greatest(), m_y.greatest())); }

  float& depth(std::size_t column, std::size_t row) { return m_depth[index(column, row)]; }
  float depth(std::size_t column, std::size_t row) const { return m_depth[index(column, row)]; }
  bool isFree(std::size_t column, std::size_t row) const { return m_free[index(column, row)] != 0; }
  /// `covered`: share of the sample's square that is focus, 0 to 1; 0: free sample, else focus.
  void set(std::size_t column, std::size_t row, float depth, float covered) {
    const std::size_t at = index(column, row);
    m_depth[at] = depth;
    m_covered[at] = covered;
    m_free[at] = covered > 0.0f ? 0.0f : 1.0f;
  }
  /// Trims `covered` so that the focus ends at the centres of its outermost samples.
  void trimFocus();

  /// Level of half the resolution: a sample is the mean of four, and focus if any of the four is.
  FillLevel halved() const;

  /// Continues the boundary's depths by `length`, step by step: into the focus with the focus's own
  /// slopes, limited to steepestBoundary, and out of the focus with slopes that decay. Coarser
  /// levels need both: their samples do not end where the focus ends.
  void continueBoundary(double length);

  /// Fills the free samples, cubic between the centres of the coarser samples.
  void start(const FillLevel& coarse);

  /// `steps` of Chebyshev's iteration for  L L u - L u / length² = 0  at the free samples near the
  /// boundary: elsewhere the coarser level's surface is as good.
  void relax(double length, int steps);

  /// Solves directly; for a few thousand samples.
  void solve(double length);

private:
  /// Focus sample beside free ones: L there is `fixed`, from the sample itself and its focus
  /// neighbours (limited in slope), plus weights times the depths of its free neighbours.
  struct Edge {
    std::size_t at;
    float fixed;
    float left, right, up, down;
  };

  /// Upper bound of the operator's eigenvalues.
  double highest(double tension) const;

  template <typename Function>
  void forFree(const Function& function) const {
    for (std::size_t at = 0; at < m_free.size(); ++at)
      if (m_free[at] != 0.0f)
        function(at);
  }

  /// Area of a sample, mm²; area * L is symmetric.
  double area(std::size_t at) const {
    return m_x.width(at % m_stride - 1) * m_y.width(at / m_stride - 1);
  }

  /// Calls back with each neighbour of a sample and the neighbour's weight in L.
  template <typename Function>
  void forWeights(std::size_t at, const Function& function) const {
    const Stencil x = m_x.stencil(at % m_stride - 1), y = m_y.stencil(at / m_stride - 1);
    const std::pair<std::size_t, float> all[] = {
        {at - 1, x.before}, {at + 1, x.after}, {at - m_stride, y.before}, {at + m_stride, y.after}};
    for (const auto& [neighbour, weight] : all)
      if (weight != 0.0f)
        function(neighbour, double{weight});
  }

  /// Calls back with each neighbour of a sample, its offset in memory, and its distance, mm.
  template <typename Function>
  void forNeighbours(std::size_t at, const Function& function) const {
    const auto stride = static_cast<std::ptrdiff_t>(m_stride);
    const std::size_t column = at % m_stride - 1, row = at / m_stride - 1;
    if (column > 0)
      function(at - 1, -1, m_x.spacing(column - 1));
    if (column + 1 < columns())
      function(at + 1, 1, m_x.spacing(column));
    if (row > 0)
      function(at - m_stride, -stride, m_y.spacing(row - 1));
    if (row + 1 < rows())
      function(at + m_stride, stride, m_y.spacing(row));
  }

  /// Depth continued from the known neighbours (mean).
  float continued(std::size_t at, const std::vector<float>& own,
                  const std::vector<std::uint8_t>& known, double length) const;

  std::size_t index(std::size_t column, std::size_t row) const {
    return (row + 1) * m_stride + column + 1;
  }

  /// Finds the focus samples beside free ones.
  void findBoundary();

  /// Computes m_edges. `stiffness`: upper limit of the ratio (boundary weight / plate weight).
  void stiffen(float stiffness);

  Edge edge(std::size_t column, std::size_t row, float stiffness) const;

  /// Computes the curvature L u along `runs` and at the boundary.
  void curve(const std::vector<SampleRun>& runs, float* curvature) const;

  void move(const std::vector<SampleRun>& runs, const float* curvature, float* change,
            float tension, float keep, float step);

  RowStencil rowStencil(const SampleRun& run) const;

  FillAxis m_x, m_y;
  std::size_t m_stride;
  std::vector<float> m_depth;   ///< mm, less the buffer's reference
  std::vector<float> m_free;    ///< 1; 0: focus, margin
  std::vector<float> m_covered; ///< share of each sample's square that is focus
  std::vector<Edge> m_edges;
};

} // namespace fenestra
