#include "image/Compare.h"

#include "base/Error.h"
#include "image/StudentT.h"

#include <array>

namespace fenestra {

namespace {

constexpr std::array<const char*, 3> colourNames = {"R", "G", "B"};
constexpr std::array<const char*, 3> errorNames = {"error.R", "error.G", "error.B"};
constexpr double fullColourZ = 5.0;

using Planes = std::array<const std::vector<float>*, 3>;

Planes findPlanes(const Image& image, const std::array<const char*, 3>& names) {
  return {image.find(names[0]), image.find(names[1]), image.find(names[2])};
}

bool complete(const Planes& planes) {
  return planes[0] && planes[1] && planes[2];
}

Planes colours(const Image& image) {
  const Planes planes = findPlanes(image, colourNames);
  if (!complete(planes))
    throw inputError("pictures", "one has no channels R, G and B; compare pictures in colour");
  return planes;
}

std::string sizeOf(const Image& image) {
  return std::to_string(image.width) + "x" + std::to_string(image.height);
}

void requireSameSize(const Image& a, const Image& b) {
  if (a.width != b.width || a.height != b.height)
    throw inputError("pictures", "are of different sizes, " + sizeOf(a) + " and " + sizeOf(b) +
                                     "; compare pictures of one size");
}

double square(double x) {
  return x * x;
}

/// Both pictures of a comparison, value by value.
struct Pair {
  Planes a, b, errorA, errorB;
  std::size_t pixels;

  Pair(const Image& imageA, const Image& imageB)
      : a(colours(imageA)),
        b(colours(imageB)),
        errorA(findPlanes(imageA, errorNames)),
        errorB(findPlanes(imageB, errorNames)),
        pixels(a[0]->size()) {
    requireSameSize(imageA, imageB);
  }

  bool hasErrors() const { return complete(errorA) && complete(errorB); }
  double difference(std::size_t c, std::size_t i) const {
    return static_cast<double>((*a[c])[i]) - static_cast<double>((*b[c])[i]);
  }
  double variance(std::size_t c, std::size_t i) const {
    return square((*errorA[c])[i]) + square((*errorB[c])[i]);
  }
  double rounding(std::size_t c, std::size_t i) const {
    return 0x1p-24 * std::max(std::abs((*a[c])[i]), std::abs((*b[c])[i]));
  }
  /// True if the values are equal to the rounding of a float.
  bool agrees(std::size_t c, std::size_t i) const {
    return std::abs(difference(c, i)) <= 2.0 * rounding(c, i);
  }
  /// True if the value carries no statistical information: both errors are 0, or one is 0 and the
  /// values are equal (background, whatever error one renderer states); "0" and "equal" mean to the
  /// rounding of a float. Excluded from z.
  bool saysNothing(std::size_t c, std::size_t i) const {
    const bool exactA = std::abs((*errorA[c])[i]) <= rounding(c, i);
    const bool exactB = std::abs((*errorB[c])[i]) <= rounding(c, i);
    return (exactA && exactB) || ((exactA || exactB) && agrees(c, i));
  }
};

/// Adds the differences of one channel to `result`, as sums.
void accumulate(const Pair& pair, std::size_t c, Comparison& result) {
  const bool hasErrorB = complete(pair.errorB);
  for (std::size_t i = 0; i < pair.pixels; ++i) {
    const double b = (*pair.b[c])[i];
    const double d = pair.difference(c, i);
    const double own = hasErrorB ? square((*pair.errorB[c])[i]) : 0.0;
    result.relMse += (square(d) - own) / (square(b) + 0.01);
    result.rmse += square(d);
    if (!(std::abs(d) <= result.maxDifference) && !std::isnan(result.maxDifference))
      result.maxDifference = std::abs(d);
    result.notFinite += !std::isfinite(d);
    result.meanA[static_cast<int>(c)] += (*pair.a[c])[i];
    result.meanB[static_cast<int>(c)] += b;
  }
}

ZStatistics zStatistics(const Pair& pair, int width) {
  ZStatistics z;
  double squares = 0.0, above = 0.0;
  for (std::size_t c = 0; c < 3; ++c) {
    double sum = 0.0, variance = 0.0;
    for (std::size_t i = 0; i < pair.pixels; ++i) {
      const double d = pair.difference(c, i), v = pair.variance(c, i);
      sum += d;
      variance += v;
      if (pair.saysNothing(c, i))
        continue;
      const double value = d / std::sqrt(v);
      ++z.count;
      z.mean += value;
      squares += square(value);
      above += std::abs(value) > 3.0;
      if (std::abs(value) > z.largest) {
        z.largest = std::abs(value);
        z.column = static_cast<int>(i) % width;
        z.row = static_cast<int>(i) / width;
        z.channel = colourNames[c][0];
      }
    }
    z.imageMean[static_cast<int>(c)] = sum == 0.0 ? 0.0 : sum / std::sqrt(variance);
  }
  const double count = std::max(static_cast<double>(z.count), 1.0);
  z.mean /= count;
  z.deviation =
      std::sqrt(std::max(squares - count * square(z.mean), 0.0) / std::max(count - 1.0, 1.0));
  z.shareAbove3 = above / count;
  return z;
}

/// z of largest modulus among a pixel's channels; a channel that says nothing counts as 0.
double largestZ(const Pair& pair, std::size_t i) {
  double largest = 0.0;
  for (std::size_t c = 0; c < 3; ++c) {
    const double z =
        pair.saysNothing(c, i) ? 0.0 : pair.difference(c, i) / std::sqrt(pair.variance(c, i));
    if (!(std::abs(z) <= std::abs(largest)))
      largest = z;
  }
  return largest;
}

double meanDifference(const Pair& pair, std::size_t i) {
  return (pair.difference(0, i) + pair.difference(1, i) + pair.difference(2, i)) / 3.0;
}

/// Signed values to show, with full colour at modulus 1.
std::vector<double> signedDifferences(const Pair& pair) {
  std::vector<double> values(pair.pixels);
  double scale = pair.hasErrors() ? fullColourZ : 0.0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    values[i] = pair.hasErrors() ? largestZ(pair, i) : meanDifference(pair, i);
    if (!pair.hasErrors() && std::isfinite(values[i]))
      scale = std::max(scale, std::abs(values[i]));
  }
  if (scale > 0.0)
    for (double& value : values)
      value /= scale;
  return values;
}

/// A picture with standard errors.
struct Estimates {
  Planes means, errors;
  const std::vector<float>* samples;

  explicit Estimates(const Image& image)
      : means(colours(image)),
        errors(findPlanes(image, errorNames)),
        samples(image.find("samples.N")) {
    if (!complete(errors))
      throw inputError("pictures", "one has no channels error.R, error.G and error.B; compare "
                                   "renders with all layers");
  }
  double mean(std::size_t c, std::size_t i) const { return (*means[c])[i]; }
  double variance(std::size_t c, std::size_t i) const { return square((*errors[c])[i]); }
  double count(std::size_t i) const { return samples ? (*samples)[i] : 0.0; }
};

/// Sums over one tile and channel.
struct TileSums {
  double mean = 0.0, variance = 0.0, samples = 0.0;
  int pixels = 0;

  void add(const Estimates& image, std::size_t c, std::size_t i) {
    mean += image.mean(c, i);
    variance += image.variance(c, i);
    samples += image.count(i);
    ++pixels;
  }
};

TileSums sumTile(const Image& image, const Estimates& estimates, std::size_t c, int left, int top,
                 int size) {
  TileSums sums;
  for (int row = top; row < std::min(top + size, image.height); ++row)
    for (int column = left; column < std::min(left + size, image.width); ++column)
      sums.add(estimates, c,
               static_cast<std::size_t>(row) * static_cast<std::size_t>(image.width) +
                   static_cast<std::size_t>(column));
  return sums;
}

/// p-value of one channel of one pixel (see agreementProbability).
double differenceProbability(const Estimates& a, const Estimates& b, std::size_t c, std::size_t i) {
  const double nA = a.count(i), nB = b.count(i);
  const double mean = (nA * a.mean(c, i) + nB * b.mean(c, i)) / (nA + nB);
  const double perSample =
      (square(nA) * a.variance(c, i) + square(nB) * b.variance(c, i)) / (nA + nB);
  const double paths = std::min(nA, nB) * std::min(1.0, square(mean) / perSample);
  const double t = (a.mean(c, i) - b.mean(c, i)) / std::sqrt(perSample * (1.0 / nA + 1.0 / nB));
  return studentTail(t, paths);
}

Rgb divergingColour(double t) {
  if (!std::isfinite(t))
    return Rgb::Zero();
  const double fade = 1.0 - std::min(std::abs(t), 1.0);
  return t > 0.0 ? Rgb(1.0, fade, fade) : Rgb(fade, fade, 1.0);
}

} // namespace

Comparison compareImages(const Image& a, const Image& b) {
  const Pair pair(a, b);
  Comparison result;
  for (std::size_t c = 0; c < 3; ++c)
    accumulate(pair, c, result);
  const auto pixels = static_cast<double>(pair.pixels);
  result.relMse /= 3.0 * pixels;
  result.rmse = std::sqrt(result.rmse / (3.0 * pixels));
  result.psnr = -20.0 * std::log10(result.rmse);
  result.meanA /= pixels;
  result.meanB /= pixels;
  if (pair.hasErrors())
    result.z = zStatistics(pair, a.width);
  return result;
}

Image differenceImage(const Image& a, const Image& b) {
  const Pair pair(a, b);
  const std::vector<double> values = signedDifferences(pair);
  Image image{a.width, a.height, {}, {}};
  for (std::size_t c = 0; c < 3; ++c) {
    auto& plane = image.channels[colourNames[c]];
    plane.resize(pair.pixels);
    for (std::size_t i = 0; i < pair.pixels; ++i)
      plane[i] = static_cast<float>(divergingColour(values[i])[static_cast<int>(c)]);
  }
  return image;
}

Image tileMeans(const Image& image, int size) {
  const Estimates estimates(image);
  size = std::min(size, std::max(image.width, image.height));
  Image result{(image.width + size - 1) / size, (image.height + size - 1) / size, {}, {}};
  for (int row = 0; row < result.height; ++row)
    for (int column = 0; column < result.width; ++column) {
      TileSums sums;
      for (std::size_t c = 0; c < 3; ++c) {
        sums = sumTile(image, estimates, c, column * size, row * size, size);
        result.channels[colourNames[c]].push_back(static_cast<float>(sums.mean / sums.pixels));
        result.channels[errorNames[c]].push_back(
            static_cast<float>(std::sqrt(sums.variance) / sums.pixels));
      }
      if (estimates.samples)
        result.channels["samples.N"].push_back(static_cast<float>(sums.samples));
    }
  return result;
}

double agreementProbability(const Image& a, const Image& b) {
  const Pair pair(a, b);
  const Estimates estimatesA(a), estimatesB(b);
  if (!estimatesA.samples || !estimatesB.samples)
    throw inputError("pictures", "one has no channel samples.N; compare renders with all layers");
  double least = 1.0, count = 0.0;
  for (std::size_t c = 0; c < 3; ++c)
    for (std::size_t i = 0; i < pair.pixels; ++i) {
      if (pair.saysNothing(c, i) && pair.agrees(c, i))
        continue;
      const double p = differenceProbability(estimatesA, estimatesB, c, i);
      least = std::isnan(p) ? 0.0 : std::min(least, p); // NaN: exact, or not finite
      ++count;
    }
  return count == 0.0 ? 1.0 : -std::expm1(count * std::log1p(-least)); // 1 - (1 - p)^count
}

void attachError(Image& image, const Image& error) {
  requireSameSize(image, error);
  const Planes planes = colours(error);
  for (std::size_t c = 0; c < 3; ++c)
    image.channels[errorNames[c]] = *planes[c];
}

} // namespace fenestra
