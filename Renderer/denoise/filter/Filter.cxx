#include "denoise/filter/Filter.h"

#include "denoise/filter/BoxSums.h"
#include "denoise/filter/ErrorEstimate.h"
#include "denoise/filter/WindowFit.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace fenestra::core {
namespace {

constexpr int levels = 4;      ///< half-widths 2, 4, 8, 16
constexpr int singleLevel = 2; ///< for images without half buffers

using FittedPlanes = std::vector<Plane>;

/// True if all active pixels are opaque, so that alpha needs no fit.
bool isOpaque(const FilterInput& input) {
  for (std::size_t i = 0; i < input.pixelCount(); ++i)
    if (input.isActive[i] &&
        !(input.even[3][i] == 1.0F && (!input.hasHalfBuffers || input.odd[3][i] == 1.0F)))
      return false;
  return true;
}

/// 1 for active pixels whose colors and features are all finite, else 0.
Plane findActivePixels(const FilterInput& input, const FittedPlanes& color) {
  Plane active(input.pixelCount());
  for (std::size_t i = 0; i < active.size(); ++i)
    active[i] = input.isActive[i] ? 1.0F : 0.0F;
  const auto deactivate = [&active](const Plane& plane) {
    for (std::size_t i = 0; i < active.size(); ++i)
      if (!std::isfinite(plane[i]))
        active[i] = 0.0F;
  };
  std::ranges::for_each(color, deactivate);
  std::ranges::for_each(input.features, deactivate);
  return active;
}

/// Normalizes a feature to mean 0 and standard deviation 1 over the active pixels, and to 0
/// elsewhere. Returns false if it is constant.
bool standardize(Plane& feature, const Plane& active) {
  double count = 0.0, sum = 0.0, squares = 0.0;
  for (std::size_t i = 0; i < feature.size(); ++i)
    if (active[i] > 0.0F) {
      count += 1.0;
      sum += static_cast<double>(feature[i]);
    }
  const double mean = sum / std::max(count, 1.0);
  for (std::size_t i = 0; i < feature.size(); ++i)
    if (active[i] > 0.0F) {
      const double difference = static_cast<double>(feature[i]) - mean;
      squares += difference * difference;
    }
  const double deviation = std::sqrt(squares / std::max(count, 1.0));
  if (!(deviation > 1e-6 * std::abs(mean)) || !std::isfinite(deviation))
    return false;
  const double scale = 1.0 / deviation;
  for (std::size_t i = 0; i < feature.size(); ++i)
    feature[i] = active[i] > 0.0F
                     ? static_cast<float>((static_cast<double>(feature[i]) - mean) * scale)
                     : 0.0F;
  return true;
}

FitInput prepareInput(FilterInput& input, std::size_t channels) {
  FitInput fit{input.width, input.height, {}, {}, {}, input.stop};
  for (std::size_t c = 0; c < channels; ++c)
    fit.color.push_back(std::move(input.even[c]));
  for (std::size_t c = 0; c < channels && input.hasHalfBuffers; ++c)
    fit.color.push_back(std::move(input.odd[c]));
  fit.active = findActivePixels(input, fit.color);
  for (Plane& plane : fit.color)
    for (std::size_t i = 0; i < plane.size(); ++i)
      if (fit.active[i] == 0.0F)
        plane[i] = 0.0F;
  std::vector<char> isUsed(input.features.size());
  tbb::parallel_for(std::size_t{0}, isUsed.size(),
                    [&](std::size_t i) { isUsed[i] = standardize(input.features[i], fit.active); });
  for (std::size_t i = 0; i < isUsed.size(); ++i)
    if (isUsed[i])
      fit.features.push_back(std::move(input.features[i]));
  return fit;
}

/// Weights of squared errors for the selection. Relative to a slightly blurred result of the
/// smallest windows, which depends little on the pixel's own noise.
Plane computeSelectionWeight(const FitInput& fit, const FittedPlanes& smallest,
                             std::size_t channel) {
  const MaskedMean blur(fit.active, fit.width, fit.height, 1);
  const Plane &even = smallest[channel], &odd = smallest[smallest.size() / 2 + channel];
  Plane mean(fit.active.size());
  for (std::size_t i = 0; i < mean.size(); ++i)
    mean[i] = 0.5F * fit.active[i] * (even[i] + odd[i]);
  Plane weight = blur(mean);
  for (float& w : weight)
    w = relativeWeight(w);
  return weight;
}

/// Scores candidates by their estimated relative error, averaged over colors and over 21x21 pixels
/// around each pixel. Excludes the 5x5 pixels that the pixel's own noise affects, since noise that
/// influences the selection would bias the estimate.
class CandidateScorer {
public:
  CandidateScorer(const FitInput& fit, const FittedPlanes& smallest)
      : m_fit(fit), m_mean(fit.active, fit.width, fit.height, 10, 2) {
    for (std::size_t c = 0; c < 3; ++c)
      m_weight[c] = computeSelectionWeight(fit, smallest, c);
  }

  Plane scoreRaw(const std::array<Plane, 3>& variance) const {
    return average([&](std::size_t c, std::size_t i) { return variance[c][i]; });
  }
  Plane score(const FittedPlanes& fitted) const {
    const std::size_t odd = fitted.size() / 2; // first plane of the second half buffer
    return average([&](std::size_t c, std::size_t i) {
      const ErrorEstimate estimate = estimateError(fitted[c][i], fitted[odd + c][i],
                                                   m_fit.color[c][i], m_fit.color[odd + c][i]);
      return estimate.variance + estimate.bias;
    });
  }

private:
  template <typename Error>
  Plane average(const Error& error) const {
    Plane sum(m_fit.active.size(), 0.0F);
    for (std::size_t c = 0; c < 3; ++c)
      for (std::size_t i = 0; i < sum.size(); ++i)
        if (m_fit.active[i] > 0.0F)
          sum[i] += m_weight[c][i] * error(c, i);
    return m_mean(sum);
  }

  const FitInput& m_fit;
  MaskedMean m_mean;
  std::array<Plane, 3> m_weight;
};

/// Candidates: unfiltered, then filtered with each window size.
class Candidates {
public:
  explicit Candidates(const FitInput& fit) : m_fit(fit), m_fitted(levels) {
    tbb::parallel_for(0, levels, [&](int level) {
      m_fitted[static_cast<std::size_t>(level)] = fitWindows(fit, level);
    });
  }

  std::size_t count() const { return m_fitted.size() + 1; }
  const FittedPlanes& smallest() const { return m_fitted.front(); }
  const FittedPlanes& operator[](std::size_t k) const {
    return k == 0 ? m_fit.color : m_fitted[k - 1];
  }

private:
  const FitInput& m_fit;
  std::vector<FittedPlanes> m_fitted;
};

/// Per pixel: index of the candidate with the smallest estimated error.
std::vector<std::uint8_t> chooseCandidates(const FitInput& fit, const Candidates& candidates,
                                           const std::array<Plane, 3>& variance) {
  const CandidateScorer scorer(fit, candidates.smallest());
  Plane least = scorer.scoreRaw(variance);
  std::vector<std::uint8_t> choice(least.size(), 0);
  for (std::size_t k = 1; k < candidates.count(); ++k) {
    const Plane score = scorer.score(candidates[k]);
    for (std::size_t i = 0; i < score.size(); ++i)
      if (score[i] < least[i]) {
        least[i] = score[i];
        choice[i] = static_cast<std::uint8_t>(k);
      }
  }
  return choice;
}

/// Blends the candidates, weighted by how often each is chosen in the 5x5 pixels around.
FittedPlanes blendCandidates(const FitInput& fit, const Candidates& candidates,
                             const std::vector<std::uint8_t>& choice) {
  const MaskedMean mean(fit.active, fit.width, fit.height, 2);
  FittedPlanes blend(fit.color.size(), Plane(choice.size(), 0.0F));
  Plane chosen(choice.size());
  for (std::size_t k = 0; k < candidates.count(); ++k) {
    for (std::size_t i = 0; i < choice.size(); ++i)
      chosen[i] = choice[i] == k ? fit.active[i] : 0.0F;
    const Plane fraction = mean(chosen);
    tbb::parallel_for(std::size_t{0}, blend.size(), [&](std::size_t c) {
      const Plane& candidate = candidates[k][c];
      for (std::size_t i = 0; i < choice.size(); ++i)
        blend[c][i] += fraction[i] * candidate[i];
    });
  }
  return blend;
}

/// Unfiltered colors: the mean of the half buffers.
FourPlanes averageHalves(const FilterInput& input) {
  FourPlanes color = input.even;
  for (std::size_t c = 0; c < color.size() && input.hasHalfBuffers; ++c)
    for (std::size_t i = 0; i < color[c].size(); ++i)
      color[c][i] = 0.5F * (color[c][i] + input.odd[c][i]);
  return color;
}

/// Adds the error of inactive pixels: the standard error of their samples, 0 if deterministic.
void addInactiveErrors(const std::array<Plane, 3>& variance, const Plane& active,
                       FilteredImage& image) {
  double sum = 0.0;
  for (std::size_t c = 0; c < 3; ++c)
    for (std::size_t i = 0; i < active.size(); ++i) {
      if (active[i] > 0.0F)
        continue;
      image.error[c][i] = std::sqrt(variance[c][i]);
      const float relative = variance[c][i] * relativeWeight(image.color[c][i]);
      sum += std::isfinite(relative) ? static_cast<double>(relative) : 0.0;
    }
  image.estimatedError += sum / (3.0 * static_cast<double>(active.size()));
}

void clampColors(FilteredImage& image) {
  for (Plane& plane : image.color)
    for (float& value : plane)
      value = std::max(value, 0.0F);
  for (float& alpha : image.color[3])
    alpha = std::min(alpha, 1.0F);
}

} // namespace

FittedPlanes filterAdaptively(const FitInput& fit, const std::array<Plane, 3>& variance) {
  const Candidates candidates(fit);
  return blendCandidates(fit, candidates, chooseCandidates(fit, candidates, variance));
}

FilteredImage filterImage(FilterInput input) {
  if (input.features.size() > SumLayout::maxFeatures)
    throw std::logic_error("too many features for the filter");
  FilteredImage image;
  image.color = averageHalves(input); // inactive pixels keep these
  const std::size_t channels = isOpaque(input) ? 3 : 4;
  const FitInput fit = prepareInput(input, channels);
  const FittedPlanes chosen =
      input.hasHalfBuffers ? filterAdaptively(fit, input.variance) : fitWindows(fit, singleLevel);
  const std::size_t odd = input.hasHalfBuffers ? channels : 0; // as in CandidateScorer::score
  for (std::size_t c = 0; c < channels; ++c)
    for (std::size_t i = 0; i < fit.active.size(); ++i)
      if (fit.active[i] > 0.0F)
        image.color[c][i] = 0.5F * (chosen[c][i] + chosen[odd + c][i]);
  if (input.hasHalfBuffers) {
    estimateErrors(fit, chosen, image);
    addInactiveErrors(input.variance, fit.active, image);
  }
  clampColors(image);
  return image;
}

} // namespace fenestra::core
