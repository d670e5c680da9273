#include "filter/ToldError.h"

#include "filter/Boxes.h"

#include <algorithm>
#include <cmath>

namespace fenestra {
namespace {

double sumPlane(const Plane& plane) {
  double sum = 0.0;
  for (const float value : plane)
    sum += static_cast<double>(value);
  return sum;
}

struct Parts {
  std::array<Plane, 3> variance, bias; ///< relative
};

Parts partsOf(const FitInput& fit, const std::vector<Plane>& filtered, const FilteredImage& image) {
  Parts parts;
  const std::size_t other = fit.color.size() / 2;
  for (std::size_t c = 0; c < 3; ++c) {
    parts.variance[c].resize(fit.active.size());
    parts.bias[c].resize(fit.active.size());
    for (std::size_t i = 0; i < fit.active.size(); ++i) {
      if (fit.active[i] == 0.0F)
        continue; // its colours may be infinite
      const Told told = toldError(filtered[c][i], filtered[other + c][i], fit.color[c][i],
                                  fit.color[other + c][i]);
      // Where windows cross black, the error is at most all that is there.
      const float weight = std::min(relativeWeight(image.color[c][i]), 1.0F / told.variance);
      parts.variance[c][i] = weight * told.variance;
      parts.bias[c][i] = weight * told.bias;
    }
  }
  return parts;
}

/// Mean over the picture of the bias part, drawn toward the prior, and its standard error.
struct Bias {
  double mean, deviation;
};

Bias biasOf(const Parts& parts, double variance, double count) {
  constexpr double priorRatio = 0.65, priorDeviation = 0.7; // of the variance
  double sum = 0.0, squares = 0.0;
  for (std::size_t i = 0; i < parts.bias[0].size(); ++i) {
    const double mean =
        static_cast<double>(parts.bias[0][i] + parts.bias[1][i] + parts.bias[2][i]) / 3.0;
    sum += mean;
    squares += mean * mean;
  }
  const double mean = sum / count;
  const double ofMean = std::max(squares / count - mean * mean, 0.0) / count;
  const double ofPrior = priorDeviation * priorDeviation * variance * variance;
  if (!(ofMean + ofPrior > 0.0))
    return {std::max(mean, 0.0), 0.0};
  // Weights of the two: the other's variance over the sum of both.
  const double told =
      (std::max(mean, 0.0) * ofPrior + priorRatio * variance * ofMean) / (ofMean + ofPrior);
  return {told, std::sqrt(ofMean * ofPrior / (ofMean + ofPrior))};
}

} // namespace

void tellErrors(const FitInput& fit, const std::vector<Plane>& filtered, FilteredImage& image) {
  const Plane& active = fit.active;
  const double count = std::max(sumPlane(active), 1.0);
  const Parts parts = partsOf(fit, filtered, image);
  double variance = 0.0;
  for (const Plane& plane : parts.variance)
    variance += sumPlane(plane) / (3.0 * count);
  const Bias bias = biasOf(parts, variance, count);

  const MaskedMean near(active, fit.width, fit.height, 3), wide(active, fit.width, fit.height, 10);
  std::array<Plane, 3> local;
  double nearSum = 0.0, wideSum = 0.0;
  for (std::size_t c = 0; c < 3; ++c) {
    image.error[c] = near(parts.variance[c]);
    local[c] = wide(parts.bias[c]);
    for (std::size_t i = 0; i < active.size(); ++i) {
      local[c][i] = std::max(local[c][i], 0.0F) * active[i];
      image.error[c][i] *= active[i];
    }
    nearSum += sumPlane(image.error[c]) / (3.0 * count);
    wideSum += sumPlane(local[c]) / (3.0 * count);
  }
  const double byVariance = nearSum > 0.0 ? (wideSum > 0.0 ? 0.5 : 1.0) * bias.mean / nearSum : 0.0;
  const double byBias = wideSum > 0.0 ? (nearSum > 0.0 ? 0.5 : 1.0) * bias.mean / wideSum : 0.0;
  for (std::size_t c = 0; c < 3; ++c)
    for (std::size_t i = 0; i < active.size(); ++i) {
      const float told = image.error[c][i] * static_cast<float>(1.0 + byVariance) +
                         local[c][i] * static_cast<float>(byBias);
      image.error[c][i] = active[i] > 0.0F
                              ? std::sqrt(std::max(told, 0.0F) / relativeWeight(image.color[c][i]))
                              : 0.0F;
    }
  const double fraction =
      sumPlane(active) / static_cast<double>(std::max<std::size_t>(active.size(), 1));
  image.toldError = fraction * (variance + bias.mean);
  image.toldDeviation = fraction * bias.deviation;
}

} // namespace fenestra
