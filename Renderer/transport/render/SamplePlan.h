#pragma once
// How a picture's samples are shared out among its pixels.

#include "image/Film.h"

namespace fenestra {

/// Either all pixels get the same number, or, after a pilot, more where the picture is noisier: the
/// mean of se^2 / (x^2 + 0.01), what Film::noise() states, is least for the time that it takes
/// where each pixel's share is proportional to s = sqrt(variance / (x^2 + 0.01) / cost of a path).
///
/// A pixel's s is taken from the pilot samples of the pixels around it, never from its own. So the
/// number of its samples does not depend on their values, and their mean is unbiased, those of the
/// pilot included; but for what its samples change of all pixels' sum of s, and of the noise at
/// which rendering stops: parts of one in the number of pixels. Pictures too small for that to be
/// nothing get the same number everywhere.
class SamplePlan {
public:
  /// Plan with one number for all pixels.
  SamplePlan() = default;
  /// Pictures with fewer pixels get one number for all.
  static constexpr std::size_t leastPixels = 2048;

  /// The pilot has one number of samples, at least two, in every pixel that is not certain. Certain
  /// pixels are left out of all sums.
  explicit SamplePlan(const Film& pilot);

  /// A stage of the plan: `mean` samples a pixel, on average.
  class Stage {
  public:
    /// Samples of a pixel; never fewer than in a stage with a smaller mean.
    std::uint64_t count(std::size_t pixel) const;
    /// Greatest number of samples of a pixel, over the mean: >= 1.
    double greatestShare() const;

  private:
    friend class SamplePlan;
    const SamplePlan* m_plan;
    std::uint64_t m_mean;
    double m_perNoise = 0.0; ///< samples for s = 1
  };
  Stage at(std::uint64_t mean) const;

private:
  std::uint64_t m_pilot = 0;
  std::vector<float> m_noise;    ///< s of each pixel, 0 of certain ones; none: all the same
  std::vector<float> m_sorted;   ///< s of those that are not certain, least first
  std::vector<double> m_sumFrom; ///< of m_sorted, from each to the end
};

} // namespace fenestra
