#pragma once
// One resolution of SmoothFill's multigrid. For SmoothFill.cxx.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

namespace fenestra {

struct RowStencil;
struct SampleRun;

/// Weights of the two neighbours in a second derivative along an axis, mm^-2.
struct Stencil {
  float before, after;
};

/// Sample coordinates, mm, and stencils of one axis. Boundary condition: slope 0 at both ends.
class FillAxis {
public:
  explicit FillAxis(std::vector<double> coordinates) : m_at(std::move(coordinates)) {
    const std::size_t last = m_at.size() - 1;
    for (std::size_t i = 0; i <= last; ++i) {
      const double before = i == 0 ? 0.0 : spacing(i - 1);
      const double after = i == last ? 0.0 : spacing(i);
      const double width = i == 0 ? after : i == last ? before : 0.5 * (before + after);
      m_before.push_back(weight(width * before));
      m_after.push_back(weight(width * after));
      m_width.push_back(width > 0.0 ? width : 1.0);
      m_maxWeightSum = std::max(m_maxWeightSum, double{m_before[i]} + m_after[i]);
    }
  }

  std::size_t size() const { return m_at.size(); }
  /// Distance from sample i to the next, mm.
  double spacing(std::size_t i) const { return std::abs(m_at[i + 1] - m_at[i]); }
  FillAxis coarsen() const {
    std::vector<double> coarse;
    for (std::size_t i = 0; i < m_at.size(); i += 2)
      coarse.push_back(0.5 * (m_at[i] + m_at[std::min(i + 1, m_at.size() - 1)]));
    return FillAxis(std::move(coarse));
  }

  Stencil stencil(std::size_t i) const { return {m_before[i], m_after[i]}; }
  const float* before() const { return m_before.data(); }
  const float* after() const { return m_after.data(); }
  double maxWeightSum() const { return m_maxWeightSum; }   ///< before + after of a stencil
  double width(std::size_t i) const { return m_width[i]; } ///< of sample i, mm

private:
  static float weight(double area) { return area > 0.0 ? static_cast<float>(1.0 / area) : 0.0f; }

  std::vector<double> m_at, m_width;
  std::vector<float> m_before, m_after; ///< of the stencils
  double m_maxWeightSum = 0.0;
};

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
        m_coverage(m_depth.size(), 0.0f) {}

  std::size_t columns() const { return m_x.size(); }
  std::size_t rows() const { return m_y.size(); }
  bool isSmall() const { return std::max(columns(), rows()) <= 8; }
  /// True if `solve` takes little time and memory.
  bool isSolvable() const { return columns() * rows() <= 8192; }
  /// Least distance of samples, mm.
  double pitch() const {
    return 1.0 / std::sqrt(0.5 * std::max(m_x.maxWeightSum(), m_y.maxWeightSum()));
  }

  float& depth(std::size_t column, std::size_t row) { return m_depth[index(column, row)]; }
  float depth(std::size_t column, std::size_t row) const { return m_depth[index(column, row)]; }
  bool isFree(std::size_t column, std::size_t row) const { return m_free[index(column, row)] != 0; }
  /// `covered`: share of the sample's square that is focus, 0 to 1; 0: free sample, else focus.
  void set(std::size_t column, std::size_t row, float depth, float coverage) {
    const std::size_t at = index(column, row);
    m_depth[at] = depth;
    m_coverage[at] = coverage;
    m_free[at] = coverage > 0.0f ? 0.0f : 1.0f;
  }
  /// Trims `covered` so that the focus ends at the centres of its outermost samples.
  void trimFocus();

  /// Level of half the resolution: a sample is the mean of four, and focus if any of the four is.
  FillLevel coarsen() const;

  /// Continues the boundary's depths by `length`, step by step: into the focus with the focus's own
  /// slopes, limited to maxBoundarySlope, and out of the focus with slopes that decay. Coarser
  /// levels need both: their samples do not end where the focus ends.
  void extendBoundary(double length);

  /// Fills the free samples, cubic between the centres of the coarser samples.
  void prolongate(const FillLevel& coarse);

  /// `steps` of Chebyshev's iteration for  L L u - L u / length² = 0  at the free samples near the
  /// boundary: elsewhere the coarser level's surface is as good.
  void relax(double length, int steps);

  /// Solves directly; for a few thousand samples.
  void solve(double length);

private:
  /// Focus sample beside free ones: L there is `fixed`, from the sample itself and its focus
  /// neighbours (limited in slope), plus weights times the depths of its free neighbours.
  struct BoundarySample {
    std::size_t at;
    float fixed = 0.0f;
    std::array<float, 4> weights{}; ///< per side of the sample
  };

  template <typename Function>
  void forEachFree(const Function& function) const {
    for (std::size_t at = 0; at < m_free.size(); ++at)
      if (m_free[at] != 0.0f)
        function(at);
  }

  struct Neighbor {
    std::size_t side, at;
    double distance; ///< mm
    float weight;    ///< in L
  };
  /// Calls back with each neighbour of a sample.
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

  /// Offsets in memory to the neighbours on the four sides.
  std::array<std::ptrdiff_t, 4> offsets() const {
    const auto stride = static_cast<std::ptrdiff_t>(m_stride);
    return {-1, 1, -stride, stride};
  }

  /// Depth continued from the known neighbours (mean).
  float extrapolate(std::size_t at, const std::vector<float>& own,
                    const std::vector<std::uint8_t>& known, double length) const;

  std::size_t index(std::size_t column, std::size_t row) const {
    return (row + 1) * m_stride + column + 1;
  }

  /// Finds the focus samples beside free ones.
  void findBoundary();

  /// Computes m_edges. `stiffness`: upper limit of the ratio (boundary weight / plate weight).
  void computeBoundary(float stiffness);

  BoundarySample makeBoundarySample(std::size_t at, float stiffness) const;

  /// Computes the curvature L u along `runs` and at the boundary.
  void applyLaplacian(const std::vector<SampleRun>& runs, float* laplacian) const;

  void updateDepths(const std::vector<SampleRun>& runs, const float* laplacian, float* change,
                    float tension, float momentum, float step);

  RowStencil rowStencil(const SampleRun& run) const;

  FillAxis m_x, m_y;
  std::size_t m_stride;
  std::vector<float> m_depth;    ///< mm, less the buffer's reference
  std::vector<float> m_free;     ///< 1; 0: focus, margin
  std::vector<float> m_coverage; ///< share of each sample's square that is focus
  std::vector<BoundarySample> m_boundary;
};

} // namespace fenestra
