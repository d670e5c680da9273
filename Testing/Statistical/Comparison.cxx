#include "Comparison.h"

#include "Oracle/Oracle.h"

#include <algorithm>

namespace fenestra::core::testing {
namespace {

constexpr int tileSize = 4;

oracle::Estimates toEstimates(const Film& film, std::uint64_t samples) {
  oracle::Estimates estimates(film.width(), film.height(), samples);
  for (std::size_t i = 0; i < film.pixelCount(); ++i) {
    const PixelSums& sums = film.pixels()[i];
    oracle::PixelEstimate& pixel = estimates.pixels[i];
    pixel.samples = static_cast<double>(samples); // also of deterministic pixels
    pixel.mean = sums.mean;
    pixel.m2 = sums.standardError().square() * pixel.samples * (pixel.samples - 1.0);
    pixel.first = oracle::FirstCollision(static_cast<double>(sums.collidedSamples), sums.depth,
                                         sums.albedo.mean()) /
                  pixel.samples;
  }
  return estimates;
}

/// Moments of one path's radiance per channel, over a complete image: events that are rare in one
/// pixel occur in others. See Estimated.
struct PathMoments {
  Rgb skewness = Rgb::Zero(), brightness = Rgb::Zero();
};

/// Sums over pixels, which give the mean of their means.
struct Sums {
  Rgb mean = Rgb::Zero(), variance = Rgb::Zero();
  oracle::FirstCollision first = oracle::FirstCollision::Zero();
  oracle::FirstCollision firstVariance = oracle::FirstCollision::Zero();
  double samples = 0.0, pixels = 0.0;
  double blocks = 0.0; ///< Estimated::blocks

  void add(const oracle::PixelEstimate& pixel) {
    mean += pixel.mean;
    variance += pixel.variance();
    first += pixel.first;
    firstVariance += pixel.firstVariance();
    samples += pixel.samples;
    pixels += 1.0;
  }
  Estimated channel(int c, const PathMoments& moments = {}) const {
    return {mean[c] / pixels, variance[c] / (pixels * pixels),
            samples,          moments.skewness[c],
            blocks,           moments.brightness[c]};
  }
  /// Sums of images whose samples depend on each other within blocks of `size`
  /// (PixelSums::block).
  Sums withBlocks(double size) const {
    Sums sums = *this;
    sums.blocks = samples / size;
    return sums;
  }
};

PathMoments computePathMoments(const oracle::Estimates& image) {
  Rgb squares = Rgb::Zero(), cubes = Rgb::Zero(), sum = Rgb::Zero(), squaresOfMeans = Rgb::Zero();
  double samples = 0.0;
  for (const oracle::PixelEstimate& pixel : image.pixels) {
    squares += pixel.m2;
    cubes += pixel.m3;
    sum += pixel.samples * pixel.mean;
    squaresOfMeans += pixel.samples * pixel.mean.square();
    samples += pixel.samples;
  }
  const Rgb sigma = (squares / samples).sqrt();
  PathMoments moments;
  for (int c = 0; c < 3; ++c) {
    if (squares[c] > 0.0)
      moments.skewness[c] = cubes[c] / samples / (sigma[c] * sigma[c] * sigma[c]);
    if (sum[c] > 0.0)
      moments.brightness[c] = (squares[c] + squaresOfMeans[c]) / sum[c];
  }
  return moments;
}

/// Sums over a square of pixels.
Sums sumPixels(const oracle::Estimates& image, int left, int top, int size) {
  Sums sums;
  for (int row = top; row < top + size; ++row)
    for (int column = left; column < left + size; ++column)
      sums.add(image.pixels[static_cast<std::size_t>(row * image.width + column)]);
  return sums;
}

/// Minimum of many p-values, corrected for their number.
class MinProbability {
public:
  void add(const std::optional<double>& probability) {
    if (!probability)
      return;
    m_minimum = std::min(m_minimum, *probability);
    m_count += 1.0;
  }
  double corrected() const { return m_count > 0.0 ? sidak(m_minimum, m_count) : 1.0; }

private:
  double m_minimum = 1.0, m_count = 0.0;
};

/// Compares tiles of `size` x `size` pixels; `visit` receives the p-value of one channel of each.
template <typename Visit>
double compareTiles(const Outcome& outcome, int size, Visit&& visit) {
  const PathMoments moments = computePathMoments(outcome.reference);
  MinProbability minimum;
  int channel = outcome.combination.index;
  for (int top = 0; top < outcome.reference.height; top += size)
    for (int left = 0; left < outcome.reference.width; left += size) {
      const Sums a = sumPixels(outcome.fenestra, left, top, size).withBlocks(Sampler::blockSize);
      const Sums b = sumPixels(outcome.reference, left, top, size);
      for (int c = 0; c < 3; ++c)
        minimum.add(welchProbability(a.channel(c, moments), b.channel(c, moments)));
      const int one = ++channel % 3;
      const auto p = welchProbability(a.channel(one), b.channel(one));
      if (p && hasManyPaths(b.channel(one, moments)))
        visit(*p);
    }
  return minimum.corrected();
}

void compareImage(Outcome& outcome) {
  const int size = outcome.reference.width;
  const Sums a = sumPixels(outcome.fenestra, 0, 0, size).withBlocks(Sampler::blockSize);
  const Sums b = sumPixels(outcome.reference, 0, 0, size);
  const PathMoments moments = computePathMoments(outcome.reference);
  MinProbability minimum;
  for (int c = 0; c < 3; ++c)
    minimum.add(welchProbability(a.channel(c, moments), b.channel(c, moments)));
  const double collidedFraction = 0.5 * (a.first[0] / a.pixels + b.first[0] / b.pixels);
  // Both renderers sample first collisions from the same distribution: the oracle's variance
  // applies to both. If the oracle's paths are all equal, it is that of a quantity that is
  // equal in all colliding paths and 0 in all others.
  for (int i = 0; i < 3; ++i) {
    double variance = b.firstVariance[i] / (b.pixels * b.pixels);
    if (variance == 0.0) {
      const double mean = 0.5 * (a.first[i] + b.first[i]) / a.pixels;
      const bool isRareMedium = i == 2 && b.first[i] == 0.0; // albedo, amid black medium
      variance = isRareMedium ? mean * (1.0 - mean) / b.samples
                 : collidedFraction > 0.0
                     ? (1.0 - collidedFraction) * mean * mean / collidedFraction / b.samples
                     : 0.0;
    }
    minimum.add(welchProbability({a.first[i] / a.pixels, variance, a.samples},
                                 {b.first[i] / b.pixels, variance, b.samples}));
  }
  outcome.image = minimum.corrected();

  const int channel = outcome.combination.index % 3;
  const Estimated fenestra = a.channel(channel), reference = b.channel(channel);
  const std::optional<double> probability = welchProbability(fenestra, reference);
  const double difference = fenestra.mean - reference.mean;
  if (reference.mean > 0.0)
    outcome.difference = difference / reference.mean;
  if (probability)
    outcome.z = difference / std::sqrt(fenestra.variance + reference.variance);
  if (hasManyPaths(b.channel(channel, moments)))
    outcome.imageProbability = probability;
}

void compareDepths(const std::vector<double>& fenestra, const std::vector<double>& reference,
                   Outcome& outcome) {
  for (std::size_t i = 0; i < reference.size(); ++i) {
    const double difference = std::abs(fenestra[i] - reference[i]);
    if (std::isinf(fenestra[i]) && std::isinf(reference[i]))
      continue;
    if (difference < 0.01)
      outcome.depthDifference = std::max(outcome.depthDifference, difference);
    else
      ++outcome.depthDisagreements; // focus of one renderer only
  }
}

std::uint64_t makeSeed(const Combination& c, const MatrixSettings& settings,
                       std::uint64_t renderer) {
  return mixBits(2 * (1'000'000 * settings.seed + static_cast<std::uint64_t>(c.index)) + renderer);
}

} // namespace

double Outcome::probability() const {
  return sidak(std::min({pixels, tiles, image}), 3.0);
}

OracleRender renderOracle(const Combination& c, const MatrixSettings& settings) {
  std::vector<double> depths;
  const oracle::Estimates image = oracle::render(
      makeMatrixScene(c).toOracleScene(), settings.samples, makeSeed(c, settings, 1), &depths);
  return {image, depths};
}

Outcome compareWithOracle(const Combination& c, const MatrixSettings& settings,
                          OracleRender oracleRender) {
  const MatrixScene scene = makeMatrixScene(c);
  RenderSettings renderSettings = scene.settings;
  renderSettings.samples = settings.samples;
  renderSettings.seed = makeSeed(c, settings, 0);
  renderSettings.integrator = settings.integrator;
  const Film film = settings.renderer ? settings.renderer(scene.fenestra, renderSettings)
                                      : scene.fenestra.render(renderSettings).film;
  Outcome outcome{.combination = c,
                  .tileProbabilities = {},
                  .imageProbability = {},
                  .fenestra = toEstimates(film, settings.samples),
                  .reference = std::move(oracleRender.image)};
  outcome.pixels = compareTiles(outcome, 1, [](double) {});
  outcome.tiles =
      compareTiles(outcome, tileSize, [&](double p) { outcome.tileProbabilities.push_back(p); });
  compareImage(outcome);
  compareDepths(scene.fenestraDepths, oracleRender.depths, outcome);
  return outcome;
}

std::vector<HypothesisTest> testHypotheses(const std::vector<Outcome>& outcomes) {
  MinProbability pixels, tiles, images;
  std::vector<double> tileProbabilities, imageProbabilities;
  double sum = 0.0;
  for (const Outcome& c : outcomes) {
    pixels.add(c.pixels);
    tiles.add(c.tiles);
    images.add(c.image);
    tileProbabilities.insert(tileProbabilities.end(), c.tileProbabilities.begin(),
                             c.tileProbabilities.end());
    if (c.imageProbability) {
      imageProbabilities.push_back(*c.imageProbability);
      sum += c.z;
    }
  }
  const auto n = static_cast<double>(outcomes.size());
  const auto nTiles = static_cast<double>(tileProbabilities.size());
  const auto nImages = static_cast<double>(imageProbabilities.size());
  return {{"largest difference of a pixel", n, pixels.corrected()},
          {"largest difference of a tile", n, tiles.corrected()},
          {"largest difference of an image", n, images.corrected()},
          {"tiles' p-values are uniform", nTiles, uniformityProbability(tileProbabilities)},
          {"images' p-values are uniform", nImages, uniformityProbability(imageProbabilities)},
          {"images' mean difference is 0", nImages,
           normalTail(sum / std::sqrt(std::max(nImages, 1.0)))}};
}

} // namespace fenestra::core::testing
