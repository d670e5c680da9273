#include "model/filtering/NoiseEstimate.h"

#include "base/Distribution.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace fenestra::core {
namespace {

/// Window of voxels around a center.
struct Window {
  double mean, deviation;
  double residual; ///< pseudo-residual of the center
};

/// Measures windows of the volume. Scalars are used as they are, or logarithmic.
class WindowSampler {
public:
  WindowSampler(const Volume& volume, bool isLogarithmic)
      : m_volume(volume), m_isLogarithmic(isLogarithmic), m_sliceAxis(findSliceAxis(volume.grid)) {
    for (int axis = 0; axis < 3; ++axis) {
      const std::int64_t wanted = axis == m_sliceAxis ? 1 : 2;
      m_radius[axis] = std::min(wanted, (volume.grid.size[axis] - 1) / 2);
    }
  }

  /// At most `most` windows, distributed over the volume. Empty for less than 3 voxels in the
  /// slice.
  std::vector<Window> sample(std::int64_t most) const {
    for (int axis = 0; axis < 3; ++axis)
      if (axis != m_sliceAxis && m_radius[axis] == 0)
        return {};
    return std::visit([&](const auto& voxels) { return measureAll(voxels, most); },
                      m_volume.voxels);
  }

private:
  template <typename Voxels>
  std::vector<Window> measureAll(const Voxels& voxels, std::int64_t most) const {
    constexpr double golden = 0.6180339887498949; // its multiples modulo 1 are evenly distributed
    const Size3 inner = m_volume.grid.size - 2 * m_radius;
    const std::int64_t all = inner.prod(), count = std::min(all, most);
    std::vector<Window> windows;
    windows.reserve(static_cast<std::size_t>(count));
    for (std::int64_t i = 0; i < count; ++i) {
      const double place = static_cast<double>(i) * golden;
      const auto at =
          count == all
              ? i
              : static_cast<std::int64_t>((place - std::floor(place)) * static_cast<double>(all));
      windows.push_back(measure(
          voxels, Size3(at % inner.x(), at / inner.x() % inner.y(), at / inner.x() / inner.y()) +
                      m_radius));
    }
    return windows;
  }

  template <typename Voxels>
  Window measure(const Voxels& voxels, const Size3& center) const {
    const auto read = [&](const Size3& at) {
      const auto value = static_cast<double>(voxels[linearIndex(at, m_volume.grid.size)]);
      return m_isLogarithmic ? std::log1p(value - m_volume.minimum) : value;
    };
    const double middle = read(center); // differences from it are exact for integers
    double sum = 0.0, squares = 0.0, count = 0.0;
    Size3 step;
    for (step.z() = -m_radius.z(); step.z() <= m_radius.z(); ++step.z())
      for (step.y() = -m_radius.y(); step.y() <= m_radius.y(); ++step.y())
        for (step.x() = -m_radius.x(); step.x() <= m_radius.x(); ++step.x()) {
          const double difference = read(center + step) - middle;
          sum += difference;
          squares += difference * difference;
          count += 1.0;
        }
    double neighbors = 0.0;
    for (int axis = 0; axis < 3; ++axis)
      if (axis != m_sliceAxis)
        neighbors += read(center + Size3::Unit(axis)) + read(center - Size3::Unit(axis));
    const double variance = (squares - sum * sum / count) / (count - 1.0);
    return {middle + sum / count, std::sqrt(std::max(variance, 0.0)),
            std::sqrt(0.8) * (middle - 0.25 * neighbors)};
  }

  const Volume& m_volume;
  bool m_isLogarithmic;
  int m_sliceAxis;
  Size3 m_radius = Size3::Zero();
};

/// Most frequent deviation, from a smoothed histogram of those below the 90th percentile.
double findMode(std::vector<double> deviations) {
  constexpr int bins = 120, reach = 6;
  constexpr double sigma = 2.0; // bins
  std::ranges::sort(deviations);
  const double last = deviations[deviations.size() * 9 / 10];
  if (last == 0.0)
    return 0.0;
  std::vector<double> histogram(bins + 2 * reach, 0.0), smooth(bins, 0.0);
  for (const double deviation : deviations)
    if (deviation < last)
      histogram[static_cast<std::size_t>(reach + deviation / last * bins)] += 1.0;
  for (int bin = 0; bin < bins; ++bin)
    for (int k = -reach; k <= reach; ++k)
      smooth[static_cast<std::size_t>(bin)] +=
          std::exp(-0.5 * k * k / (sigma * sigma)) *
          histogram[static_cast<std::size_t>(bin) + static_cast<std::size_t>(reach + k)];
  const auto mode = std::ranges::max_element(smooth) - smooth.begin();
  return last / bins * (static_cast<double>(mode) + 0.5);
}

double estimateDeviation(std::vector<double> residuals) {
  const double center = findMedian(residuals);
  for (double& residual : residuals)
    residual = std::abs(residual - center);
  return 1.4826 * findMedian(residuals);
}

} // namespace

int findSliceAxis(const Grid& grid) {
  const Vec3 spacing = grid.spacing();
  int slice = 0;
  for (int axis = 1; axis < 3; ++axis)
    if (spacing[axis] >= spacing[slice])
      slice = axis;
  return slice;
}

double estimateNoise(const Volume& volume, Modality modality) {
  constexpr std::int64_t mostWindows = 300'000;
  constexpr std::size_t fewestWindows = 100;
  constexpr double tissueRange = 150.0; // HU on both sides of water
  const auto windows = WindowSampler(volume, modality == Modality::us).sample(mostWindows);
  double mean = 0.0;
  for (const Window& window : windows)
    mean += window.mean / static_cast<double>(windows.size());
  std::vector<double> deviations, residuals;
  for (const Window& window : windows)
    if (modality == Modality::ct ? std::abs(window.mean) < tissueRange : window.mean > mean) {
      deviations.push_back(window.deviation);
      residuals.push_back(window.residual);
    }
  if (deviations.size() < fewestWindows)
    return 0.0;
  switch (modality) {
  case Modality::ct:
    return std::min(findMode(std::move(deviations)), 1.5 * estimateDeviation(std::move(residuals)));
  case Modality::mr:
  case Modality::pt:
    return 1.2 * estimateDeviation(std::move(residuals));
  case Modality::us:
    return findMode(std::move(deviations));
  }
  return 0.0;
}

} // namespace fenestra::core
