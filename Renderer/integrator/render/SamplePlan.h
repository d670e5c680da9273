#pragma once
// Distribution of a picture's samples among its pixels.

#include "image/Film.h"

namespace fenestra {

/// Either all pixels get the same number, or, after a pilot, more where the picture is noisier: the
/// mean of se^2 / (x^2 + 0.01), Film::noise() squared, is least for a given time if each pixel's
/// share is proportional to s = sqrt(variance / (x^2 + 0.01) / cost of a path).
///
/// A pixel's s is taken from the pilot samples of the pixels around, never from its own: the number
/// of a pixel's samples does not depend on their values, and their mean, pilot included, is
/// unbiased. Remaining bias: a pixel influences its own count only through global sums (of s, and
/// the noise at which rendering stops), O(1 / pixels). Below `minPixels` the plan is uniform.
class SamplePlan {
public:
  /// Uniform plan.
  SamplePlan() = default;
  /// Number of uncertain pixels below which the plan is uniform.
  static constexpr std::size_t minPixels = 2048;
  /// Samples of a pixel in a render's pilot.
  static constexpr std::uint64_t pilotSamples = 16;

  /// `pilot` must have the same number of samples, at least two, in every pixel that is not
  /// certain. Certain pixels do not count in the mean.
  explicit SamplePlan(const Film& pilot);

  /// Plan after a pilot of pilotSamples, of which s of each pixel is known (noise()).
  explicit SamplePlan(std::vector<float> noise);
  /// s of each pixel, 0: certain pixel; empty: uniform plan.
  const std::vector<float>& noise() const { return m_noise; }

  /// A stage of the plan: `mean` samples a pixel, on average.
  class Stage {
  public:
    /// Samples of a pixel; never fewer than in a stage with a smaller mean.
    std::uint64_t count(std::size_t pixel) const;
    /// Greatest count of any pixel / mean; >= 1.
    double maxRatio() const;

  private:
    friend class SamplePlan;
    const SamplePlan* m_plan;
    std::uint64_t m_mean;
    double m_samplesPerNoise = 0.0; ///< samples for s = 1; 0: uniform
  };
  Stage at(std::uint64_t mean) const;

private:
  void sort();

  std::uint64_t m_pilot = 0;
  std::vector<float> m_noise;
  std::vector<float> m_sorted;   ///< s of the uncertain pixels, ascending
  std::vector<double> m_sumFrom; ///< sums of m_sorted from each element to the end
};

} // namespace fenestra
