#include "filter/Filter.h"

#include "filter/Boxes.h"
#include "filter/ToldError.h"
#include "filter/WindowFit.h"

#include <algorithm>
#include <cmath>

namespace fenestra {
namespace {

constexpr int levels = 4;      ///< half-widths 2, 4, 8, 16
constexpr int singleLevel = 2; ///< of pictures without halves
constexpr std::size_t channels = 4;

using Fitted = std::array<Plane, SumLayout::colors>;

/// 1: the pixel takes part, and all that the fit reads of it is finite.
Plane openPixels(const FilterInput& input, const Fitted& color) {
  Plane open(input.pixelCount());
  for (std::size_t i = 0; i < open.size(); ++i) {
    const auto isFinite = [i](const Plane& plane) { return std::isfinite(plane[i]); };
    open[i] = input.isOpen[i] && std::ranges::all_of(color, isFinite) &&
                      std::ranges::all_of(input.features, isFinite)
                  ? 1.0F
                  : 0.0F;
  }
  return open;
}

/// Adds the feature with mean 0 and deviation 1 over the open pixels; nothing where it is constant.
void addStandardised(const Plane& feature, FitInput& fit) {
  double count = 0.0, sum = 0.0;
  for (std::size_t i = 0; i < feature.size(); ++i)
    if (fit.open[i] > 0.0F) {
      count += 1.0;
      sum += static_cast<double>(feature[i]);
    }
  const double mean = sum / std::max(count, 1.0);
  double squares = 0.0;
  for (std::size_t i = 0; i < feature.size(); ++i)
    if (fit.open[i] > 0.0F)
      squares += std::pow(static_cast<double>(feature[i]) - mean, 2);
  const double deviation = std::sqrt(squares / std::max(count, 1.0));
  if (!(deviation > 1e-6 * std::abs(mean)) || !std::isfinite(deviation))
    return;
  Plane& plane = fit.features.emplace_back(feature.size(), 0.0F);
  for (std::size_t i = 0; i < feature.size(); ++i)
    if (fit.open[i] > 0.0F)
      plane[i] = static_cast<float>((static_cast<double>(feature[i]) - mean) / deviation);
}

FitInput prepared(const FilterInput& input, bool hasHalves) {
  FitInput fit{input.width, input.height, {}, {}, {}};
  for (std::size_t c = 0; c < channels; ++c) {
    fit.color[c] = input.even[c];
    fit.color[channels + c] = hasHalves ? input.odd[c] : input.even[c];
  }
  fit.open = openPixels(input, fit.color);
  for (Plane& plane : fit.color)
    for (std::size_t i = 0; i < plane.size(); ++i)
      if (fit.open[i] == 0.0F)
        plane[i] = 0.0F;
  for (const Plane& feature : input.features)
    addStandardised(feature, fit);
  return fit;
}

/// Weights of the choice: relative to a slightly blurred picture of small windows, which hardly
/// knows the pixel's own noise.
Plane choiceWeight(const FitInput& fit, const Fitted& small, std::size_t channel) {
  const OpenMean blur(fit.open, fit.width, fit.height, 1);
  Plane mean(fit.open.size());
  for (std::size_t i = 0; i < mean.size(); ++i)
    mean[i] = 0.5F * fit.open[i] * (small[channel][i] + small[channels + channel][i]);
  Plane weight = blur(mean);
  for (float& w : weight)
    w = relativeWeight(w);
  return weight;
}

/// Mean over colours of the told error, relative, averaged over 21x21 pixels around each pixel but
/// not over the 5x5 that its own noise reaches: noise that helped to choose would flatter the
/// choice.
class Judge {
public:
  Judge(const FilterInput& input, const FitInput& fit, const Fitted& small)
      : m_input(input), m_fit(fit), m_mean(fit.open, fit.width, fit.height, 10, 2) {
    for (std::size_t c = 0; c < 3; ++c)
      m_weight[c] = choiceWeight(fit, small, c);
  }

  Plane raw() const {
    return averaged([this](std::size_t c, std::size_t i) { return m_input.variance[c][i]; });
  }
  Plane of(const Fitted& fitted) const {
    return averaged([&](std::size_t c, std::size_t i) {
      const Told told = toldError(fitted[c][i], fitted[channels + c][i], m_fit.color[c][i],
                                  m_fit.color[channels + c][i]);
      return told.variance + told.bias;
    });
  }

private:
  template <typename Error>
  Plane averaged(const Error& error) const {
    Plane sum(m_fit.open.size(), 0.0F);
    for (std::size_t i = 0; i < sum.size(); ++i)
      if (m_fit.open[i] > 0.0F)
        for (std::size_t c = 0; c < 3; ++c)
          sum[i] += m_weight[c][i] * error(c, i);
    return m_mean(sum);
  }

  const FilterInput& m_input;
  const FitInput& m_fit;
  OpenMean m_mean;
  std::array<Plane, 3> m_weight;
};

/// Number of the candidate of least told error, by pixel.
std::vector<std::uint8_t> choices(const Judge& judge, const std::vector<Fitted>& candidates) {
  Plane least = judge.raw();
  std::vector<std::uint8_t> choice(least.size(), 0);
  for (std::size_t k = 1; k < candidates.size(); ++k) {
    const Plane told = judge.of(candidates[k]);
    for (std::size_t i = 0; i < told.size(); ++i)
      if (told[i] < least[i]) {
        least[i] = told[i];
        choice[i] = static_cast<std::uint8_t>(k);
      }
  }
  return choice;
}

/// Candidates blended by their share of the choices in the 5x5 pixels around.
Fitted blended(const std::vector<Fitted>& candidates, const std::vector<std::uint8_t>& choice,
               const FitInput& fit, std::vector<double>& shares) {
  const OpenMean mean(fit.open, fit.width, fit.height, 2);
  Fitted blend;
  for (Plane& plane : blend)
    plane.assign(choice.size(), 0.0F);
  double count = 0.0;
  for (const float open : fit.open)
    count += static_cast<double>(open);
  for (std::size_t k = 0; k < candidates.size(); ++k) {
    Plane chosen(choice.size());
    for (std::size_t i = 0; i < choice.size(); ++i)
      chosen[i] = choice[i] == k ? fit.open[i] : 0.0F;
    const Plane share = mean(chosen);
    double sum = 0.0;
    for (std::size_t i = 0; i < choice.size(); ++i)
      sum += static_cast<double>(share[i] * fit.open[i]);
    shares.push_back(count > 0.0 ? sum / count : 0.0);
    for (std::size_t c = 0; c < blend.size(); ++c)
      for (std::size_t i = 0; i < choice.size(); ++i)
        blend[c][i] += share[i] * candidates[k][c][i];
  }
  return blend;
}

/// Halves of a fit; closed pixels as they were.
struct FilteredHalves {
  FourPlanes even, odd;
};

FilteredHalves halvesOf(Fitted&& fitted, const FilterInput& input, const Plane& open,
                        bool hasHalves) {
  FilteredHalves halves;
  for (std::size_t c = 0; c < channels; ++c) {
    halves.even[c] = std::move(fitted[c]);
    halves.odd[c] = std::move(fitted[channels + c]);
    for (std::size_t i = 0; i < open.size(); ++i)
      if (open[i] == 0.0F) {
        halves.even[c][i] = input.even[c][i];
        halves.odd[c][i] = hasHalves ? input.odd[c][i] : input.even[c][i];
      }
  }
  return halves;
}

void clampColors(FilteredPicture& picture) {
  for (Plane& plane : picture.color)
    for (float& value : plane)
      value = std::max(value, 0.0F);
  for (float& alpha : picture.color[3])
    alpha = std::min(alpha, 1.0F);
}

} // namespace

FilteredPicture filtered(const FilterInput& input, bool hasHalves) {
  const FitInput fit = prepared(input, hasHalves);
  FilteredPicture picture;
  Fitted chosen;
  if (hasHalves) {
    std::vector<Fitted> candidates = {fit.color};
    for (int level = 0; level < levels; ++level)
      candidates.push_back(fitWindows(fit, level));
    const Judge judge(input, fit, candidates[1]);
    chosen = blended(candidates, choices(judge, candidates), fit, picture.shares);
  } else {
    chosen = fitWindows(fit, singleLevel);
  }
  const FilteredHalves halves = halvesOf(std::move(chosen), input, fit.open, hasHalves);
  for (std::size_t c = 0; c < channels; ++c) {
    picture.color[c].resize(fit.open.size());
    for (std::size_t i = 0; i < fit.open.size(); ++i)
      picture.color[c][i] = 0.5F * (halves.even[c][i] + halves.odd[c][i]);
  }
  if (hasHalves)
    tellErrors(input, fit.open, halves.even, halves.odd, picture);
  clampColors(picture);
  return picture;
}

} // namespace fenestra
