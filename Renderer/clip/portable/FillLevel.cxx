#include "clip/portable/FillLevel.h"

#include "clip/portable/SmoothFill.h"

namespace fenestra::core {
namespace {

/// Calls function(row) for each row, in parallel, in chunks of several short rows.
template <typename Function>
void forEachRow(const FillLevel& level, const ParallelLoop& loop, const Function& function) {
  loop(level.rows(), 1 + 32768 / level.columns(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t row = begin; row != end; ++row)
      function(row);
  });
}

} // namespace

void FillLevel::trimFocus() {
  const std::vector<float> untrimmed = m_coverage;
  for (std::size_t at = m_stride + 1; at + m_stride + 1 < untrimmed.size(); ++at)
    if (untrimmed[at] > 0.0f) {
      // A quadrant of the sample is covered as far as the three neighbors around it are.
      float corners = 0.0f;
      for (const std::size_t row : {at - m_stride, at + m_stride})
        for (const std::size_t column : {at - 1, at + 1})
          corners += untrimmed[row] * untrimmed[column] * untrimmed[row + column - at];
      m_coverage[at] = std::max(0.25f * corners, 0.1f);
    }
}

FillLevel FillLevel::coarsen() const {
  FillLevel coarse(m_x.coarsen(), m_y.coarsen());
  for (std::size_t row = 0; row < coarse.rows(); ++row)
    for (std::size_t column = 0; column < coarse.columns(); ++column) {
      const std::size_t i[] = {2 * column, std::min(2 * column + 1, columns() - 1)};
      const std::size_t j[] = {2 * row, std::min(2 * row + 1, rows() - 1)};
      float depths = 0.0f, coverage = 0.0f;
      for (const std::size_t r : j)
        for (const std::size_t c : i) {
          depths += 0.25f * depth(c, r);
          coverage += 0.25f * m_coverage[index(c, r)];
        }
      coarse.set(column, row, depths, coverage);
    }
  return coarse;
}

void FillLevel::extendBoundary(double length) {
  const std::vector<float> own = m_depth;
  std::vector<std::uint8_t> known(m_depth.size(), 0); // 1: depth is set
  findBoundary();
  std::vector<std::size_t> front, next;
  for (const float free : {0.0f, 1.0f}) { // inward first: the outward pass uses those slopes
    front.clear();
    for (const BoundarySample& sample : m_boundary) {
      known[sample.at] = 1;
      front.push_back(sample.at);
    }
    for (double extended = 0.0; extended < length && !front.empty(); extended += pitch()) {
      next.clear();
      for (const std::size_t from : front)
        forEachNeighbor(from, [&](const Neighbor& neighbor) {
          const std::size_t at = neighbor.at;
          if (known[at] == 0 && m_free[at] == free) {
            known[at] = 2; // found in this step
            next.push_back(at);
          }
        });
      for (const std::size_t at : next)
        m_depth[at] = extrapolate(at, own, known, length);
      for (const std::size_t at : next)
        known[at] = 1;
      std::swap(front, next);
    }
  }
}

float FillLevel::extrapolate(std::size_t at, const std::vector<float>& own,
                             const std::vector<std::uint8_t>& known, double length) const {
  float sum = 0.0f, count = 0.0f;
  forEachNeighbor(at, [&](const Neighbor& neighbor) {
    const auto [side, from, distance, weight] = neighbor;
    if (known[from] != 1)
      return;
    const auto limit = static_cast<float>(maxNearSlope * distance);
    const std::size_t before = from + static_cast<std::size_t>(offsets()[side]);
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

void FillLevel::prolongate(const FillLevel& coarse, const ParallelLoop& loop) {
  // Interpolation weights of four neighboring coarse samples, for the first of the two fine samples
  // in a coarse one; mirrored for the second.
  constexpr float weights[] = {-5.0f / 128, 35.0f / 128, 105.0f / 128, -7.0f / 128};
  forEachRow(*this, loop, [&](std::size_t row) {
    const std::size_t count = coarse.columns();
    const auto clampIndex = [](std::size_t i, std::ptrdiff_t step, std::size_t size) {
      const auto at = static_cast<std::ptrdiff_t>(i) + step;
      return static_cast<std::size_t>(
          std::clamp<std::ptrdiff_t>(at, 0, static_cast<std::ptrdiff_t>(size) - 1));
    };
    std::vector<float> across(count + 4); // with a margin of two
    for (std::ptrdiff_t i = 0; i < 4; ++i) {
      const std::ptrdiff_t step = row % 2 == 0 ? i - 2 : 2 - i;
      const float weight = weights[i];
      const float* const from =
          &coarse.m_depth[coarse.index(0, clampIndex(row / 2, step, coarse.rows()))];
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

void FillLevel::findBoundary() {
  const auto stride = static_cast<std::ptrdiff_t>(m_stride);
  for (std::size_t row = 0; row < rows(); ++row) {
    const float* free = &m_free[index(0, row)];
    for (std::size_t column = 0; column < columns(); ++column, ++free)
      if (free[0] == 0.0f && free[-1] + free[1] + free[-stride] + free[stride] > 0.0f)
        m_boundary.push_back({index(column, row)});
  }
}

void FillLevel::computeBoundary() {
  if (m_boundary.empty())
    findBoundary();
  for (BoundarySample& sample : m_boundary)
    sample = makeBoundarySample(sample.at);
}

FillLevel::BoundarySample FillLevel::makeBoundarySample(std::size_t at) const {
  BoundarySample sample{at};
  // Only the part of the sample's area outside the focus bends.
  const float bend = 1.0f / std::max(1.0f - m_coverage[at], 1.0f / maxStiffness);
  forEachNeighbor(at, [&](const Neighbor& neighbor) {
    const float weight = bend * neighbor.weight;
    if (m_free[neighbor.at] != 0.0f) {
      sample.weights[neighbor.side] = weight;
      sample.fixed -= weight * m_depth[at];
    } else {
      const auto limit = static_cast<float>(maxNearSlope * neighbor.distance);
      sample.fixed += weight * std::clamp(m_depth[neighbor.at] - m_depth[at], -limit, limit);
    }
  });
  return sample;
}

} // namespace fenestra::core
