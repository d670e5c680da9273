#include "denoise/filter/ErrorEstimate.h"

#include "denoise/filter/BoxSums.h"

#include <algorithm>
#include <cmath>

namespace fenestra::core {
namespace {

double sumPlane(const Plane& plane) {
  double sum = 0.0;
  for (const float value : plane)
    sum += static_cast<double>(value);
  return sum;
}

struct ErrorPlanes {
  std::array<Plane, 3> variance, bias; ///< relative
};

ErrorPlanes estimatePlanes(const FitInput& fit, const std::vector<Plane>& filtered,
                           const FilteredImage& image) {
  ErrorPlanes planes;
  const std::size_t odd = fit.color.size() / 2; // first plane of the second half buffer
  for (std::size_t c = 0; c < 3; ++c) {
    planes.variance[c].resize(fit.active.size());
    planes.bias[c].resize(fit.active.size());
    for (std::size_t i = 0; i < fit.active.size(); ++i) {
      if (fit.active[i] == 0.0F)
        continue; // its colors may be infinite
      const ErrorEstimate estimate = estimateError(filtered[c][i], filtered[odd + c][i],
                                                   fit.color[c][i], fit.color[odd + c][i]);
      // Limits the relative variance to 1, where windows extend into black regions.
      const float weight = std::min(relativeWeight(image.color[c][i]), 1.0F / estimate.variance);
      planes.variance[c][i] = weight * estimate.variance;
      planes.bias[c][i] = weight * estimate.bias;
    }
  }
  return planes;
}

/// Mean of the bias part over the image, shrunk toward the prior, and its standard error.
struct Bias {
  double mean, standardError;
};

Bias estimateBias(const ErrorPlanes& planes, double variance, double count) {
  constexpr double priorRatio = 0.65, priorDeviation = 0.7; // relative to the variance
  double sum = 0.0, squares = 0.0;
  for (std::size_t i = 0; i < planes.bias[0].size(); ++i) {
    const double mean =
        static_cast<double>(planes.bias[0][i] + planes.bias[1][i] + planes.bias[2][i]) / 3.0;
    sum += mean;
    squares += mean * mean;
  }
  const double mean = sum / count;
  const double meanVariance = std::max(squares / count - mean * mean, 0.0) / count;
  const double priorVariance = priorDeviation * priorDeviation * variance * variance;
  if (!(meanVariance + priorVariance > 0.0))
    return {std::max(mean, 0.0), 0.0};
  // Inverse-variance weighting of the two.
  const double combined =
      (std::max(mean, 0.0) * priorVariance + priorRatio * variance * meanVariance) /
      (meanVariance + priorVariance);
  return {combined, std::sqrt(meanVariance * priorVariance / (meanVariance + priorVariance))};
}

} // namespace

void estimateErrors(const FitInput& fit, const std::vector<Plane>& filtered, FilteredImage& image) {
  const Plane& active = fit.active;
  const double count = std::max(sumPlane(active), 1.0);
  const ErrorPlanes planes = estimatePlanes(fit, filtered, image);
  double variance = 0.0;
  for (const Plane& plane : planes.variance)
    variance += sumPlane(plane) / (3.0 * count);
  const Bias bias = estimateBias(planes, variance, count);

  const MaskedMean near(active, fit.width, fit.height, 3), wide(active, fit.width, fit.height, 10);
  std::array<Plane, 3> local;
  double nearSum = 0.0, wideSum = 0.0;
  for (std::size_t c = 0; c < 3; ++c) {
    image.error[c] = near(planes.variance[c]);
    local[c] = wide(planes.bias[c]);
    for (std::size_t i = 0; i < active.size(); ++i) {
      local[c][i] = std::max(local[c][i], 0.0F) * active[i];
      image.error[c][i] *= active[i];
    }
    nearSum += sumPlane(image.error[c]) / (3.0 * count);
    wideSum += sumPlane(local[c]) / (3.0 * count);
  }
  // Half of the bias is distributed by each, or all by one if the other is 0.
  const double varianceScale =
      nearSum > 0.0 ? (wideSum > 0.0 ? 0.5 : 1.0) * bias.mean / nearSum : 0.0;
  const double biasScale = wideSum > 0.0 ? (nearSum > 0.0 ? 0.5 : 1.0) * bias.mean / wideSum : 0.0;
  for (std::size_t c = 0; c < 3; ++c)
    for (std::size_t i = 0; i < active.size(); ++i) {
      const float value = image.error[c][i] * static_cast<float>(1.0 + varianceScale) +
                          local[c][i] * static_cast<float>(biasScale);
      image.error[c][i] = active[i] > 0.0F
                              ? std::sqrt(std::max(value, 0.0F) / relativeWeight(image.color[c][i]))
                              : 0.0F;
    }
  const double fraction =
      sumPlane(active) / static_cast<double>(std::max<std::size_t>(active.size(), 1));
  image.estimatedError = fraction * (variance + bias.mean);
  image.errorUncertainty = fraction * bias.standardError;
}

} // namespace fenestra::core
