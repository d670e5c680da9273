#pragma once
// Adaptive sampling: how many samples each pixel of an image gets.

#include "image/Film.h"

namespace fenestra::core {

/// Either all pixels get the same number or, after a pilot, noisier ones get more. The mean of
/// se^2 / (x^2 + 0.01), Film::noise() squared (x: a pixel's mean, se: its standard error), is
/// minimal for a given time if each pixel's number is proportional to s = sqrt(variance / (x^2 +
/// 0.01) / cost of a path).
///
/// A pixel's s is estimated from the pilot samples of its neighbors, never from its own. Its number
/// of samples thus does not depend on their values, and their mean, pilot included, is unbiased.
/// Remaining bias: a pixel affects its own count through global sums alone (of s, and the noise at
/// which the render stops), O(1 / pixels). Below minPixels the plan is uniform.
class SamplePlan {
public:
  /// Uniform plan.
  SamplePlan() = default;
  /// Number of pixels that are not deterministic below which the plan is uniform.
  static constexpr std::size_t minPixels = 2048;
  /// Samples per pixel in a render's pilot.
  static constexpr std::uint64_t pilotSamples = 16;

  /// `pilot` must have the same number of samples, at least two, in every pixel that is not
  /// deterministic. Deterministic pixels do not count in the mean.
  explicit SamplePlan(const Film& pilot);

  /// Plan after a pilot of pilotSamples, from each pixel's s (as noise() returns it).
  explicit SamplePlan(std::vector<float> noise);
  /// s of each pixel, 0: deterministic pixel; empty: uniform plan.
  const std::vector<float>& noise() const { return m_noise; }

  /// A stage of the plan: `mean` samples per pixel on average.
  class Stage {
  public:
    /// Samples of a pixel; never fewer than at a stage with a smaller mean.
    std::uint64_t count(std::size_t pixel) const;
    /// Maximum count of any pixel / mean; >= 1.
    double maxRatio() const;

  private:
    friend class SamplePlan;
    const SamplePlan* m_plan;
    std::uint64_t m_mean;
    double m_samplesPerNoise = 0.0; ///< samples per s; 0: uniform
  };
  Stage at(std::uint64_t mean) const;

private:
  void sort();

  std::uint64_t m_pilot = 0;
  std::vector<float> m_noise;
  std::vector<float> m_sorted;   ///< s of the pixels that are not deterministic, ascending
  std::vector<double> m_sumFrom; ///< sums of m_sorted from each element to the end
};

} // namespace fenestra::core
