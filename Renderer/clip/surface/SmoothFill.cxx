#include "clip/surface/SmoothFill.h"

#include "clip/surface/FillAxis.h"
#include "clip/surface/SampleTiles.h"

#include <Eigen/SparseCholesky>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <memory>

namespace fenestra {

namespace {

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

void curveRow(const RowStencil& l, const float* in, float* __restrict out) {
  for (std::size_t i = 0; i < l.count; ++i)
    out[i] = l(in, i);
}

/// One step of the iteration along a row: updates the depths u from their curvature L u.
void moveRow(const RowStencil& l, const float* curvature, const float* free, float tension,
             float keep, float step, float* __restrict change, float* __restrict depth) {
  for (std::size_t i = 0; i < l.count; ++i) {
    change[i] = keep * change[i] + free[i] * step * (tension * curvature[i] - l(curvature, i));
    depth[i] += change[i];
  }
}

/// One resolution. A margin of one sample surrounds the stored rows; stencils give it weight 0.
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
  void trimFocus() {
    const std::vector<float> whole = m_covered;
    for (std::size_t at = m_stride + 1; at + m_stride + 1 < whole.size(); ++at)
      if (whole[at] > 0.0f) {
        float corners = 0.0f;
        for (const std::size_t row : {at - m_stride, at + m_stride})
          for (const std::size_t column : {at - 1, at + 1})
            corners += whole[row] * whole[column] * whole[row + column - at];
        m_covered[at] = std::max(0.25f * corners, 0.1f);
      }
  }

  /// Level of half the resolution: a sample is the mean of four, and focus if any of the four is.
  FillLevel halved() const {
    FillLevel coarse(m_x.halved(), m_y.halved());
    for (std::size_t row = 0; row < coarse.rows(); ++row)
      for (std::size_t column = 0; column < coarse.columns(); ++column) {
        const std::size_t i[] = {2 * column, std::min(2 * column + 1, columns() - 1)};
        const std::size_t j[] = {2 * row, std::min(2 * row + 1, rows() - 1)};
        float depths = 0.0f, covered = 0.0f;
        for (const std::size_t r : j)
          for (const std::size_t c : i) {
            depths += 0.25f * depth(c, r);
            covered += 0.25f * m_covered[index(c, r)];
          }
        coarse.set(column, row, depths, covered);
      }
    return coarse;
  }

  /// Continues the boundary's depths by `length`, step by step: into the focus with the focus's own
  /// slopes, limited to steepestBoundary, and out of the focus with slopes that decay. Coarser
  /// levels need both: their samples do not end where the focus ends.
  void continueBoundary(double length) {
    const std::vector<float> own = m_depth;
    std::vector<std::uint8_t> known(m_depth.size(), 0);
    findBoundary();
    std::vector<std::size_t> front, next;
    for (const float free : {0.0f, 1.0f}) { // inward first: the outward pass reads those slopes
      front.clear();
      for (const Edge& edge : m_edges) {
        known[edge.at] = 1;
        front.push_back(edge.at);
      }
      for (double reached = 0.0; reached < length && !front.empty(); reached += pitch()) {
        next.clear();
        for (const std::size_t from : front)
          forNeighbours(from, [&](std::size_t at, std::ptrdiff_t, double) {
            if (known[at] == 0 && m_free[at] == free) {
              known[at] = 2; // found in this step
              next.push_back(at);
            }
          });
        for (const std::size_t at : next)
          m_depth[at] = continued(at, own, known, length);
        for (const std::size_t at : next)
          known[at] = 1;
        std::swap(front, next);
      }
    }
  }

  /// Fills the free samples, cubic between the centres of the coarser samples.
  void start(const FillLevel& coarse) {
    // Weights of four neighbouring coarse samples, for a fine sample in the first half of its
    // coarse one; mirrored for the second half.
    constexpr float weights[] = {-5.0f / 128, 35.0f / 128, 105.0f / 128, -7.0f / 128};
    forRows([&](std::size_t row) {
      const std::size_t count = coarse.columns();
      const auto beside = [](std::size_t i, std::ptrdiff_t step, std::size_t size) {
        const auto at = static_cast<std::ptrdiff_t>(i) + step;
        return static_cast<std::size_t>(
            std::clamp<std::ptrdiff_t>(at, 0, static_cast<std::ptrdiff_t>(size) - 1));
      };
      std::vector<float> across(count + 4); // with a margin of two
      for (std::ptrdiff_t i = 0; i < 4; ++i) {
        const std::ptrdiff_t step = row % 2 == 0 ? i - 2 : 2 - i;
        const float weight = weights[i];
        const float* const from =
            &coarse.m_depth[coarse.index(0, beside(row / 2, step, coarse.rows()))];
        for (std::size_t k = 0; k < count; ++k)
          across[k + 2] += weight * from[k];
      }
      across[0] = across[1] = across[2];
      across[count + 2] = across[count + 3] = across[count + 1];
      const float* const free = &m_free[index(0, row)];
      float* const depth = &m_depth[index(0, row)];
      for (std::size_t k = 0; k < columns() / 2; ++k) {
        const float* const at = &across[k];
        const float first =
            weights[0] * at[0] + weights[1] * at[1] + weights[2] * at[2] + weights[3] * at[3];
        const float second =
            weights[3] * at[1] + weights[2] * at[2] + weights[1] * at[3] + weights[0] * at[4];
        depth[2 * k] += free[2 * k] * (first - depth[2 * k]);
        depth[2 * k + 1] += free[2 * k + 1] * (second - depth[2 * k + 1]);
      }
      if (columns() % 2 == 1 && free[columns() - 1] != 0.0f)
        depth[columns() - 1] = across[count + 1];
    });
  }

  /// `steps` of Chebyshev's iteration for  L L u - L u / length² = 0  at the free samples near the
  /// boundary: elsewhere the coarser level's surface is as good.
  void relax(double length, int steps) {
    stiffen(stiffest);
    SampleTiles tiles(columns(), rows());
    for (const Edge& edge : m_edges)
      tiles.markAround(edge.at % m_stride - 1, edge.at / m_stride - 1);
    const std::vector<SampleRun> moved = tiles.runs(0), curved = tiles.runs(1);
    const double tension = 1.0 / (length * length);
    const double high = highest(tension);
    const double low = high / (0.25 * steps * steps);
    const double centre = 0.5 * (high + low), radius = 0.5 * (high - low);
    // Memory away from the boundary is never touched.
    const auto curvature = std::make_unique_for_overwrite<float[]>(m_depth.size());
    const auto change = std::make_unique_for_overwrite<float[]>(m_depth.size());
    for (const SampleRun& run : curved) // stencils reach a sample further
      for (const std::size_t row : {run.row, run.row + 1, run.row + 2}) {
        const std::size_t first = row * m_stride + run.begin;
        std::fill_n(&curvature[first], run.end - run.begin + 2, 0.0f);
        std::fill_n(&change[first], run.end - run.begin + 2, 0.0f);
      }
    double rho = radius / centre;
    double keep = 0.0, step = 1.0 / centre;
    for (int i = 0; i < steps; ++i) {
      curve(curved, curvature.get());
      move(moved, curvature.get(), change.get(), static_cast<float>(tension),
           static_cast<float>(keep), static_cast<float>(step));
      const double next = 1.0 / (2.0 * centre / radius - rho);
      keep = next * rho;
      step = 2.0 * next / radius;
      rho = next;
    }
  }

  /// Solves directly; for a few thousand samples.
  void solve(double length) {
    stiffen(1e6f);
    std::vector<int> unknown(m_depth.size(), -1);
    int count = 0;
    forFree([&](std::size_t at) { unknown[at] = count++; });
    if (count == 0)
      return;
    std::vector<const Edge*> edgeAt(m_depth.size(), nullptr);
    for (const Edge& edge : m_edges)
      edgeAt[edge.at] = &edge;
    Eigen::VectorXd right = Eigen::VectorXd::Zero(count);
    std::vector<Eigen::Triplet<double>> entries;
    // Adds `factor` times the curvature at a sample to an equation; of the symmetric matrix only
    // the lower half.
    const auto addCurvature = [&](int row, std::size_t at, double factor) {
      const auto add = [&](std::size_t neighbour, double weight) {
        if (unknown[neighbour] >= 0) {
          if (unknown[neighbour] <= row)
            entries.emplace_back(row, unknown[neighbour], factor * weight);
        } else
          right[row] -= factor * weight * m_depth[neighbour];
      };
      if (const Edge* const edge = edgeAt[at]) {
        right[row] -= factor * edge->fixed;
        const std::pair<std::size_t, float> beside[] = {{at - 1, edge->left},
                                                        {at + 1, edge->right},
                                                        {at - m_stride, edge->up},
                                                        {at + m_stride, edge->down}};
        for (const auto& [neighbour, weight] : beside)
          if (weight != 0.0f)
            add(neighbour, weight);
        return;
      }
      double sum = 0.0;
      forWeights(at, [&](std::size_t neighbour, double weight) {
        add(neighbour, weight);
        sum += weight;
      });
      add(at, -sum);
    };
    forFree([&](std::size_t at) {
      const double area = this->area(at);
      double sum = 1.0 / (length * length);
      forWeights(at, [&](std::size_t neighbour, double weight) {
        addCurvature(unknown[at], neighbour, area * weight);
        sum += weight;
      });
      addCurvature(unknown[at], at, -area * sum);
    });
    Eigen::SparseMatrix<double> matrix(count, count);
    matrix.setFromTriplets(entries.begin(), entries.end());
    const Eigen::VectorXd depths =
        Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>(matrix).solve(right);
    forFree([&](std::size_t at) { m_depth[at] = static_cast<float>(depths[unknown[at]]); });
  }

private:
  /// Stiffness in `relax`: more only slows convergence.
  static constexpr float stiffest = 3.0f;

  /// Upper bound of the operator's eigenvalues.
  double highest(double tension) const {
    const double most = 2.0 * (m_x.greatest() + m_y.greatest());
    return stiffest * most * (most + tension);
  }

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
                  const std::vector<std::uint8_t>& known, double length) const {
    float sum = 0.0f, count = 0.0f;
    forNeighbours(at, [&](std::size_t from, std::ptrdiff_t way, double distance) {
      if (known[from] != 1)
        return;
      const auto limit = static_cast<float>(steepestBoundary * distance);
      const std::size_t before = from + static_cast<std::size_t>(way);
      float rise = 0.0f;
      if (m_free[at] == 0.0f)
        rise = own[at] - own[from];
      else if (known[before] == 1)
        rise = (m_depth[from] - m_depth[before]) * static_cast<float>(std::exp(-distance / length));
      sum += m_depth[from] + std::clamp(rise, -limit, limit);
      count += 1.0f;
    });
    return sum / count;
  }

  /// Focus sample beside free ones: L there is `fixed`, from the sample itself and its focus
  /// neighbours (limited in slope), plus weights times the depths of its free neighbours.
  struct Edge {
    std::size_t at;
    float fixed;
    float left, right, up, down;
  };

  std::size_t index(std::size_t column, std::size_t row) const {
    return (row + 1) * m_stride + column + 1;
  }

  /// Finds the focus samples beside free ones.
  void findBoundary() {
    const auto stride = static_cast<std::ptrdiff_t>(m_stride);
    for (std::size_t row = 0; row < rows(); ++row) {
      const float* free = &m_free[index(0, row)];
      for (std::size_t column = 0; column < columns(); ++column, ++free)
        if (free[0] == 0.0f && free[-1] + free[1] + free[-stride] + free[stride] > 0.0f)
          m_edges.push_back({index(column, row), 0.0f, 0.0f, 0.0f, 0.0f, 0.0f});
    }
  }

  /// Computes m_edges. `stiffness`: upper limit of the ratio (boundary weight / plate weight).
  void stiffen(float stiffness) {
    if (m_edges.empty())
      findBoundary();
    for (Edge& each : m_edges)
      each = edge(each.at % m_stride - 1, each.at / m_stride - 1, stiffness);
  }

  Edge edge(std::size_t column, std::size_t row, float stiffness) const {
    const std::size_t at = index(column, row);
    const Stencil x = m_x.stencil(column), y = m_y.stencil(row);
    Edge edge{at, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f};
    // Only the part of the sample's square outside the focus is bent.
    const float bend = 1.0f / std::max(1.0f - m_covered[at], 1.0f / stiffness);
    const auto add = [&](float weight, std::size_t neighbour, double distance, float& free) {
      if (m_free[neighbour] != 0.0f) {
        free = weight;
        edge.fixed -= weight * m_depth[at];
      } else {
        const auto limit = static_cast<float>(steepestBoundary * distance);
        edge.fixed += weight * std::clamp(m_depth[neighbour] - m_depth[at], -limit, limit);
      }
    };
    if (column > 0)
      add(bend * x.before, at - 1, m_x.spacing(column - 1), edge.left);
    if (column + 1 < columns())
      add(bend * x.after, at + 1, m_x.spacing(column), edge.right);
    if (row > 0)
      add(bend * y.before, at - m_stride, m_y.spacing(row - 1), edge.up);
    if (row + 1 < rows())
      add(bend * y.after, at + m_stride, m_y.spacing(row), edge.down);
    return edge;
  }

  /// Calls back with each row, in parallel; short rows share a thread.
  template <typename Function>
  void forRows(const Function& function) const {
    const std::size_t grain = 1 + 32768 / columns();
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, rows(), grain), [&](const auto& range) {
      for (std::size_t row = range.begin(); row != range.end(); ++row)
        function(row);
    });
  }

  /// Calls back with each run, in parallel; runs are short and share a thread.
  template <typename Function>
  static void forRuns(const std::vector<SampleRun>& runs, const Function& function) {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, runs.size(), 256), [&](const auto& range) {
      for (std::size_t i = range.begin(); i != range.end(); ++i)
        function(runs[i]);
    });
  }

  /// Computes the curvature L u along `runs` and at the boundary.
  void curve(const std::vector<SampleRun>& runs, float* curvature) const {
    forRuns(runs, [&](const SampleRun& run) {
      const std::size_t first = index(run.begin, run.row);
      curveRow(rowStencil(run), &m_depth[first], curvature + first);
    });
    for (const Edge& edge : m_edges) {
      const float* const depth = &m_depth[edge.at];
      curvature[edge.at] = edge.fixed + edge.left * depth[-1] + edge.right * depth[1] +
                           edge.up * depth[-static_cast<std::ptrdiff_t>(m_stride)] +
                           edge.down * depth[m_stride];
    }
  }

  void move(const std::vector<SampleRun>& runs, const float* curvature, float* change,
            float tension, float keep, float step) {
    forRuns(runs, [&](const SampleRun& run) {
      const std::size_t first = index(run.begin, run.row);
      moveRow(rowStencil(run), curvature + first, &m_free[first], tension, keep, step,
              change + first, &m_depth[first]);
    });
  }

  RowStencil rowStencil(const SampleRun& run) const {
    return {m_x.before() + run.begin, m_x.after() + run.begin, m_y.stencil(run.row),
            run.end - run.begin, static_cast<std::ptrdiff_t>(m_stride)};
  }

  FillAxis m_x, m_y;
  std::size_t m_stride;
  std::vector<float> m_depth;   ///< mm, less the buffer's reference
  std::vector<float> m_free;    ///< 1; 0: focus, margin
  std::vector<float> m_covered; ///< share of each sample's square that is focus
  std::vector<Edge> m_edges;
};

FillAxis axisOf(const DepthAxis& axis) {
  std::vector<double> coordinates;
  for (std::int64_t i = 0; i < axis.size(); ++i)
    coordinates.push_back(axis.coordinate(i));
  return FillAxis(std::move(coordinates));
}

FillLevel finest(const DepthBuffer& buffer, const std::vector<Region>& regions) {
  FillLevel level(axisOf(buffer.xAxis()), axisOf(buffer.yAxis()));
  std::size_t sample = 0;
  for (std::size_t row = 0; row < level.rows(); ++row)
    for (std::size_t column = 0; column < level.columns(); ++column, ++sample)
      if (regions[sample] == Region::focus)
        level.set(column, row, buffer.depthsFromReference()[sample], 1.0f);
      else
        level.set(column, row, 0.0f, 0.0f);
  return level;
}

} // namespace

void fillSmoothly(DepthBuffer& buffer, const std::vector<Region>& regions, double length) {
  std::vector<FillLevel> levels;
  levels.push_back(finest(buffer, regions));
  levels.back().trimFocus();
  levels.back().continueBoundary(length);
  // Coarser levels would not resolve the plate's bending.
  while (!levels.back().isSmall() &&
         (levels.back().pitch() < 0.25 * length || !levels.back().isSolvable()))
    levels.push_back(levels.back().halved());
  constexpr int fewest = 24;
  levels.back().solve(length);
  for (std::size_t i = levels.size() - 1; i-- > 0;) {
    levels[i].start(levels[i + 1]);
    levels[i].relax(length, fewest << i);
  }
  const FillLevel& level = levels.front();
  std::int64_t sample = 0;
  for (std::size_t row = 0; row < level.rows(); ++row)
    for (std::size_t column = 0; column < level.columns(); ++column, ++sample)
      if (level.isFree(column, row))
        buffer.set(sample, buffer.reference() + level.depth(column, row));
}

} // namespace fenestra
