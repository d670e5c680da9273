#include "integrator/render/SamplePlan.h"

#include "base/Random.h"

#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include <algorithm>

namespace fenestra::core {
namespace {

/// Minimum s of a pixel (s: see SamplePlan), relative to the mean s: a few samples can miss rare
/// bright paths.
constexpr double minNoise = 0.25;
constexpr int radius = 2; ///< pixels to each side in averageNeighbors()

/// Variance of one sample / (x^2 + 0.01), x being the mean, averaged over the channels.
/// Stratification is ignored: the variance that it removes differs little between pixels, and would
/// be estimated from few blocks.
double relativeVariance(const PixelSums& pixel) {
  if (pixel.isDeterministic)
    return 0.0;
  const Rgb variance = pixel.m2 / static_cast<double>(pixel.samples - 1);
  return (variance / (pixel.mean.square() + 0.01)).mean();
}

/// Cost of a path, in scatterings: a base cost plus the mean number of scatterings.
double pathCost(const PixelSums& pixel) {
  constexpr double baseCost = 0.15;
  return baseCost + pixel.scatterings / static_cast<double>(pixel.samples);
}

/// Mean of the values of a film's pixels around (column, row), without that pixel itself.
double averageNeighbors(const Film& film, const std::vector<double>& values, int column, int row) {
  double sum = 0.0;
  int count = -1;
  for (int y = std::max(row - radius, 0); y <= std::min(row + radius, film.height() - 1); ++y)
    for (int x = std::max(column - radius, 0); x <= std::min(column + radius, film.width() - 1);
         ++x) {
      ++count;
      if (x != column || y != row)
        sum += values[film.index(x, y)];
    }
  return sum / count;
}

/// Hash of a pixel, uniform in [0, 1).
double dither(std::size_t pixel) {
  return static_cast<double>(mixBits(pixel + 1) >> 11) * 0x1p-53;
}

} // namespace

SamplePlan::SamplePlan(const Film& pilot) : m_pilot(pilot.sampleCounts().max) {
  const std::size_t activePixels = pilot.pixelCount() - pilot.sampleCounts().deterministicPixels;
  if (activePixels < minPixels)
    return;
  std::vector<double> variances, costs;
  for (const PixelSums& pixel : pilot.pixels()) {
    variances.push_back(relativeVariance(pixel));
    costs.push_back(pathCost(pixel));
  }
  m_noise.resize(variances.size());
  tbb::parallel_for(0, pilot.height(), [&](int row) {
    for (int column = 0; column < pilot.width(); ++column) {
      if (pilot.at(column, row).isDeterministic)
        continue;
      const auto here = [&](const std::vector<double>& values) {
        return averageNeighbors(pilot, values, column, row);
      };
      m_noise[pilot.index(column, row)] =
          static_cast<float>(std::sqrt(here(variances) / here(costs)));
    }
  });
  double sum = 0.0;
  for (const float s : m_noise)
    sum += static_cast<double>(s);
  if (!(sum > 0.0) || !std::isfinite(sum)) {
    m_noise.clear();
    return;
  }
  const auto minimum = static_cast<float>(minNoise * sum / static_cast<double>(activePixels));
  for (std::size_t i = 0; i < m_noise.size(); ++i)
    if (!pilot.pixels()[i].isDeterministic)
      m_noise[i] = std::max(m_noise[i], minimum);
  sort();
}

SamplePlan::SamplePlan(std::vector<float> noise)
    : m_pilot(pilotSamples), m_noise(std::move(noise)) {
  sort();
}

/// Sorts s and sums it up, without deterministic pixels.
void SamplePlan::sort() {
  std::ranges::copy_if(m_noise, std::back_inserter(m_sorted), [](float s) { return s > 0.0F; });
  if (m_sorted.empty())
    return m_noise.clear();
  tbb::parallel_sort(m_sorted.begin(), m_sorted.end());
  m_sumFrom.resize(m_sorted.size() + 1);
  for (std::size_t i = m_sorted.size(); i-- > 0;)
    m_sumFrom[i] = m_sumFrom[i + 1] + static_cast<double>(m_sorted[i]);
}

/// Pixels get max(pilot, perNoise s) samples. If the first k pixels of m_sorted stay at the pilot,
/// perNoise(k) follows from the mean. k is the smallest with perNoise(k) m_sorted[k] >= pilot.
SamplePlan::Stage SamplePlan::at(std::uint64_t mean) const {
  Stage stage;
  stage.m_plan = this;
  stage.m_mean = mean;
  if (m_noise.empty() || mean <= m_pilot)
    return stage;
  const auto pilot = static_cast<double>(m_pilot);
  const double total = static_cast<double>(mean) * static_cast<double>(m_sorted.size());
  const auto perNoise = [&](std::size_t k) {
    return (total - pilot * static_cast<double>(k)) / m_sumFrom[k];
  };
  std::size_t low = 0;
  std::size_t high = m_sorted.size() - 1;
  while (low < high) {
    const std::size_t k = (low + high) / 2;
    if (perNoise(k) * static_cast<double>(m_sorted[k]) >= pilot)
      high = k;
    else
      low = k + 1;
  }
  stage.m_samplesPerNoise = perNoise(low);
  return stage;
}

std::uint64_t SamplePlan::Stage::count(std::size_t pixel) const {
  if (!(m_samplesPerNoise > 0.0))
    return m_mean;
  const double planned = m_samplesPerNoise * static_cast<double>(m_plan->m_noise[pixel]);
  return std::max(m_plan->m_pilot, static_cast<std::uint64_t>(planned + dither(pixel)));
}

double SamplePlan::Stage::maxRatio() const {
  if (!(m_samplesPerNoise > 0.0))
    return 1.0;
  const double most = m_samplesPerNoise * static_cast<double>(m_plan->m_sorted.back());
  return std::max(1.0, most / static_cast<double>(m_mean));
}

} // namespace fenestra::core
