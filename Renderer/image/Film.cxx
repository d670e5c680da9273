#include "image/Film.h"

#include <utility>

namespace fenestra::core {

void PixelSums::add(const PathSample& sample) {
  if (samples % 2 == 0) {
    const std::uint64_t evenSamples = samples / 2 + 1;
    evenMean += (sample.radiance - evenMean) / static_cast<double>(evenSamples);
    evenAlpha += sample.alpha;
  }
  ++samples;
  const Rgb before = sample.radiance - mean;
  mean += before / static_cast<double>(samples);
  m2 += before * (sample.radiance - mean);
  if (blockSize > 1) {
    const std::uint64_t half = (samples - 1) % 2;
    partialSums[half] += sample.radiance;
    if (partialBlockSize(half) == 0)
      finishBlock(half);
  }
  alpha += sample.alpha;
  albedo += sample.albedo;
  normal += sample.normal;
  scatterings += sample.scatterings;
  if (sample.depth < infinity) {
    depth += sample.depth;
    ++collidedSamples;
  }
}

HalfMeans PixelSums::halfMeans() const {
  const auto all = static_cast<double>(samples);
  const std::uint64_t oddSamples = samples / 2;
  const auto odd = static_cast<double>(oddSamples);
  const double even = all - odd;
  return {evenMean, (all * mean - even * evenMean) / odd, evenAlpha / even,
          (alpha - evenAlpha) / odd};
}

/// Adds a half's last block, now complete, to the block statistics. Its samples already count.
void PixelSums::finishBlock(std::uint64_t half) {
  const Rgb sum = std::exchange(partialSums[half], Rgb::Zero());
  const double count = completeBlockCount();
  if (count < 2.0)
    return;
  // Welford 1962, with the deviation from the mean that already includes the block.
  const Rgb difference = sum / static_cast<double>(blockSize) - completeBlockMean();
  blockM2 += difference * difference * (count / (count - 1.0));
}

double PixelSums::completeBlockCount() const {
  const std::uint64_t blocks = (samples + 1) / 2 / blockSize + samples / 2 / blockSize;
  return static_cast<double>(blocks);
}

Rgb PixelSums::completeBlockMean() const {
  return (static_cast<double>(samples) * mean - partialSums[0] - partialSums[1]) /
         (completeBlockCount() * static_cast<double>(blockSize));
}

Rgb PixelSums::standardError() const {
  if (samples < 2)
    return Rgb::Zero();
  const auto n = static_cast<double>(samples);
  if (blockSize == 1)
    return (m2 / (n * (n - 1.0))).sqrt();
  Rgb squares = Rgb::Zero(); // of S_b - m_b mean
  double sizes = 0.0;        // sum of m_b^2
  for (std::uint64_t half = 0; half < 2; ++half) {
    const auto size = static_cast<double>(partialBlockSize(half));
    squares += (partialSums[half] - size * mean).square();
    sizes += size * size;
  }
  const double complete = completeBlockCount();
  if (complete > 0.0) {
    const auto size = static_cast<double>(blockSize);
    squares += size * size * (blockM2 + complete * (completeBlockMean() - mean).square());
    sizes += complete * size * size;
  }
  return (squares / (n * n - sizes)).sqrt();
}

double Film::noise() const {
  double sum = 0.0;
  for (const PixelSums& pixel : m_pixels) {
    if (pixel.isDeterministic)
      continue;
    if (pixel.samples < 2)
      return infinity;
    sum += (pixel.standardError().square() / (pixel.mean.square() + 0.01)).sum();
  }
  return std::sqrt(sum / (3.0 * static_cast<double>(m_pixels.size())));
}

SampleCounts Film::sampleCounts() const {
  SampleCounts counts{std::numeric_limits<std::uint64_t>::max(), 0, 0.0, 0};
  counts.deterministicPixels =
      static_cast<std::size_t>(std::ranges::count(m_pixels, true, &PixelSums::isDeterministic));
  const bool allDeterministic = counts.deterministicPixels == m_pixels.size();
  for (const PixelSums& pixel : m_pixels) {
    if (pixel.isDeterministic && !allDeterministic)
      continue;
    counts.min = std::min(counts.min, pixel.samples);
    counts.max = std::max(counts.max, pixel.samples);
    counts.mean += static_cast<double>(pixel.samples);
  }
  counts.mean /=
      static_cast<double>(m_pixels.size() - (allDeterministic ? 0 : counts.deterministicPixels));
  return counts;
}

} // namespace fenestra::core
