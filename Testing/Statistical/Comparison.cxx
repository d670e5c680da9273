#include "Comparison.h"

#include "Oracle/Oracle.h"

#include <algorithm>

namespace fenestra::testing {
namespace {

constexpr int tileSize = 4;

oracle::Estimates estimatesOf(const Film& film, std::uint64_t samples) {
  oracle::Estimates estimates(film.width(), film.height(), samples);
  for (std::size_t i = 0; i < film.pixelCount(); ++i) {
    const PixelSums& sums = film.pixels()[i];
    oracle::PixelEstimate& pixel = estimates.pixels[i];
    pixel.samples = static_cast<double>(samples); // all samples, even for certain pixels
    pixel.mean = sums.mean;
    pixel.m2 = sums.standardError().square() * pixel.samples * (pixel.samples - 1.0);
    pixel.first = oracle::FirstCollision(static_cast<double>(sums.collidedSamples), sums.depth,
                                         sums.albedo.mean()) /
                  pixel.samples;
  }
  return estimates;
}

/// One path's radiance in each channel over a whole picture: events that are rare in one pixel
/// occur in others. See Estimated.
struct Paths {
  Rgb skewness = Rgb::Zero(), brightness = Rgb::Zero();
};

/// Sums over pixels, for the mean of their means.
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
  Estimated channel(int c, const Paths& paths = {}) const {
    return {mean[c] / pixels,   variance[c] / (pixels * pixels), samples, paths.skewness[c], blocks,
            paths.brightness[c]};
  }
  /// Sums of pictures whose samples depend on each other within blocks of `size`
  /// (PixelSums::block).
  Sums inBlocks(double size) const {
    Sums sums = *this;
    sums.blocks = samples / size;
    return sums;
  }
};

Paths pathsOf(const oracle::Estimates& picture) {
  Rgb squares = Rgb::Zero(), cubes = Rgb::Zero(), sum = Rgb::Zero(), squaresOfMeans = Rgb::Zero();
  double samples = 0.0;
  for (const oracle::PixelEstimate& pixel : picture.pixels) {
    squares += pixel.m2;
    cubes += pixel.m3;
    sum += pixel.samples * pixel.mean;
    squaresOfMeans += pixel.samples * pixel.mean.square();
    samples += pixel.samples;
  }
  const Rgb deviation = (squares / samples).sqrt();
  Paths paths;
  for (int c = 0; c < 3; ++c) {
    if (squares[c] > 0.0)
      paths.skewness[c] = cubes[c] / samples / (deviation[c] * deviation[c] * deviation[c]);
    if (sum[c] > 0.0)
      paths.brightness[c] = (squares[c] + squaresOfMeans[c]) / sum[c];
  }
  return paths;
}

/// Sums over a square of pixels.
Sums sumsOf(const oracle::Estimates& picture, int left, int top, int size) {
  Sums sums;
  for (int row = top; row < top + size; ++row)
    for (int column = left; column < left + size; ++column)
      sums.add(picture.pixels[static_cast<std::size_t>(row * picture.width + column)]);
  return sums;
}

/// Least of many probabilities, corrected for their number.
class Least {
public:
  void add(const std::optional<double>& probability) {
    if (!probability)
      return;
    m_least = std::min(m_least, *probability);
    m_count += 1.0;
  }
  double corrected() const { return m_count > 0.0 ? sidak(m_least, m_count) : 1.0; }

private:
  double m_least = 1.0, m_count = 0.0;
};

/// Compares squares of `size` pixels; `visit` receives the probability of one channel of each.
template <typename Visit>
double compareSquares(const Outcome& outcome, int size, Visit&& visit) {
  const Paths paths = pathsOf(outcome.truth);
  Least least;
  int channel = outcome.combination.index;
  for (int top = 0; top < outcome.truth.height; top += size)
    for (int left = 0; left < outcome.truth.width; left += size) {
      const Sums a = sumsOf(outcome.product, left, top, size).inBlocks(Sampler::blockSize);
      const Sums b = sumsOf(outcome.truth, left, top, size);
      for (int c = 0; c < 3; ++c)
        least.add(welchProbability(a.channel(c, paths), b.channel(c, paths)));
      const int one = ++channel % 3;
      const auto p = welchProbability(a.channel(one), b.channel(one));
      if (p && isEven(b.channel(one, paths)))
        visit(*p);
    }
  return least.corrected();
}

void comparePicture(Outcome& outcome) {
  const int size = outcome.truth.width;
  const Sums a = sumsOf(outcome.product, 0, 0, size).inBlocks(Sampler::blockSize);
  const Sums b = sumsOf(outcome.truth, 0, 0, size);
  const Paths paths = pathsOf(outcome.truth);
  Least least;
  for (int c = 0; c < 3; ++c)
    least.add(welchProbability(a.channel(c, paths), b.channel(c, paths)));
  const double share = 0.5 * (a.first[0] / a.pixels + b.first[0] / b.pixels); // colliding paths
  // Both draw first collisions from the same distribution, so the oracle's variance serves for
  // both.
  for (int i = 0; i < 3; ++i) {
    double variance = b.firstVariance[i] / (b.pixels * b.pixels);
    if (variance == 0.0) { // the oracle's paths are all alike: what both say of that
      const double mean = 0.5 * (a.first[i] + b.first[i]) / a.pixels;
      const bool isRareMatter = i == 2 && b.first[i] == 0.0; // of any albedo, amid black
      variance = isRareMatter  ? mean * (1.0 - mean) / b.samples
                 : share > 0.0 ? (1.0 - share) * mean * mean / share / b.samples
                               : 0.0;
    }
    least.add(welchProbability({a.first[i] / a.pixels, variance, a.samples},
                               {b.first[i] / b.pixels, variance, b.samples}));
  }
  outcome.picture = least.corrected();

  const int channel = outcome.combination.index % 3;
  const Estimated product = a.channel(channel), truth = b.channel(channel);
  const std::optional<double> probability = welchProbability(product, truth);
  const double difference = product.mean - truth.mean;
  if (truth.mean > 0.0)
    outcome.difference = difference / truth.mean;
  if (probability)
    outcome.deviate = difference / std::sqrt(product.variance + truth.variance);
  if (isEven(b.channel(channel, paths)))
    outcome.pictureProbability = probability;
}

void compareDepths(const std::vector<double>& product, const std::vector<double>& truth,
                   Outcome& outcome) {
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const double difference = std::abs(product[i] - truth[i]);
    if (std::isinf(product[i]) && std::isinf(truth[i]))
      continue;
    if (difference < 0.01)
      outcome.depthDifference = std::max(outcome.depthDifference, difference);
    else
      ++outcome.depthDisagreements; // focus for one renderer only
  }
}

std::uint64_t seedOf(const Combination& c, const MatrixSettings& settings, std::uint64_t renderer) {
  return mixBits(2 * (1'000'000 * settings.seed + static_cast<std::uint64_t>(c.index)) + renderer);
}

} // namespace

double Outcome::probability() const {
  return sidak(std::min({pixels, tiles, picture}), 3.0);
}

Truth renderTruth(const Combination& c, const MatrixSettings& settings) {
  std::vector<double> depths;
  const oracle::Estimates picture =
      oracle::render(matrixScene(c).forOracle(), settings.samples, seedOf(c, settings, 1), &depths);
  return {picture, depths};
}

Outcome compareWithOracle(const Combination& c, const MatrixSettings& settings, Truth truth) {
  const MatrixScene scene = matrixScene(c);
  RenderSettings renderSettings = scene.settings;
  renderSettings.samples = settings.samples;
  renderSettings.seed = seedOf(c, settings, 0);
  renderSettings.integrator = settings.transport;
  Outcome outcome{.combination = c,
                  .tileProbabilities = {},
                  .pictureProbability = {},
                  .product =
                      estimatesOf(scene.product.render(renderSettings).film, settings.samples),
                  .truth = std::move(truth.picture)};
  outcome.pixels = compareSquares(outcome, 1, [](double) {});
  outcome.tiles =
      compareSquares(outcome, tileSize, [&](double p) { outcome.tileProbabilities.push_back(p); });
  comparePicture(outcome);
  compareDepths(scene.productDepths, truth.depths, outcome);
  return outcome;
}

std::vector<Verdict> verdicts(const std::vector<Outcome>& outcomes) {
  Least pixels, tiles, pictures;
  std::vector<double> tileProbabilities, pictureProbabilities;
  double sum = 0.0;
  for (const Outcome& c : outcomes) {
    pixels.add(c.pixels);
    tiles.add(c.tiles);
    pictures.add(c.picture);
    tileProbabilities.insert(tileProbabilities.end(), c.tileProbabilities.begin(),
                             c.tileProbabilities.end());
    if (c.pictureProbability) {
      pictureProbabilities.push_back(*c.pictureProbability);
      sum += c.deviate;
    }
  }
  const auto n = static_cast<double>(outcomes.size());
  const auto nTiles = static_cast<double>(tileProbabilities.size());
  const auto nPictures = static_cast<double>(pictureProbabilities.size());
  return {{"largest difference of a pixel", n, pixels.corrected()},
          {"largest difference of a tile", n, tiles.corrected()},
          {"largest difference of a picture", n, pictures.corrected()},
          {"tiles' probabilities are uniform", nTiles, uniformityProbability(tileProbabilities)},
          {"pictures' probabilities are uniform", nPictures,
           uniformityProbability(pictureProbabilities)},
          {"pictures' mean difference is 0", nPictures,
           normalTail(sum / std::sqrt(std::max(nPictures, 1.0)))}};
}

} // namespace fenestra::testing
