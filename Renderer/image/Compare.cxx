#include "image/Compare.h"

#include "base/Error.h"
#include "image/ImagePair.h"

namespace fenestra::core {
namespace {

constexpr double fullColorZ = 5.0; ///< |z| that a difference image shows in full color

std::string formatSize(const Image& image) {
  return std::to_string(image.width) + "x" + std::to_string(image.height);
}

/// Adds the differences of one channel to `result`, as sums.
void accumulate(const ImagePair& pair, std::size_t c, Comparison& result) {
  const bool hasErrorB = isComplete(pair.errorB);
  for (std::size_t i = 0; i < pair.pixels; ++i) {
    const double b = (*pair.b[c])[i];
    const double d = pair.difference(c, i);
    const double referenceVariance = hasErrorB ? square((*pair.errorB[c])[i]) : 0.0;
    result.relMse += (square(d) - referenceVariance) / (square(b) + 0.01);
    result.rmse += square(d);
    if (!(std::abs(d) <= result.maxDifference) && !std::isnan(result.maxDifference))
      result.maxDifference = std::abs(d);
    result.notFinite += !std::isfinite(d);
    result.meanA[static_cast<int>(c)] += (*pair.a[c])[i];
    result.meanB[static_cast<int>(c)] += b;
  }
}

ZStatistics computeZStatistics(const ImagePair& pair, int width) {
  ZStatistics z;
  double squares = 0.0, above = 0.0;
  for (std::size_t c = 0; c < 3; ++c) {
    double sum = 0.0, variance = 0.0;
    for (std::size_t i = 0; i < pair.pixels; ++i) {
      const double d = pair.difference(c, i), v = pair.variance(c, i);
      sum += d;
      variance += v;
      if (pair.isUninformative(c, i))
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
        z.channel = colorNames[c][0];
      }
    }
    z.imageMean[static_cast<int>(c)] = sum == 0.0 ? 0.0 : sum / std::sqrt(variance);
  }
  const double count = std::max(static_cast<double>(z.count), 1.0);
  z.mean /= count;
  z.deviation =
      std::sqrt(std::max(squares - count * square(z.mean), 0.0) / std::max(count - 1.0, 1.0));
  z.fractionAbove3 = above / count;
  return z;
}

/// z of largest magnitude among a pixel's channels; uninformative channels count as 0.
double findLargestZ(const ImagePair& pair, std::size_t i) {
  double largest = 0.0;
  for (std::size_t c = 0; c < 3; ++c) {
    const double z =
        pair.isUninformative(c, i) ? 0.0 : pair.difference(c, i) / std::sqrt(pair.variance(c, i));
    if (!(std::abs(z) <= std::abs(largest)))
      largest = z;
  }
  return largest;
}

double meanDifference(const ImagePair& pair, std::size_t i) {
  return (pair.difference(0, i) + pair.difference(1, i) + pair.difference(2, i)) / 3.0;
}

/// Signed values to display; magnitude 1 gives full color.
std::vector<double> computeDifferences(const ImagePair& pair) {
  std::vector<double> values(pair.pixels);
  double scale = pair.hasErrors() ? fullColorZ : 0.0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    values[i] = pair.hasErrors() ? findLargestZ(pair, i) : meanDifference(pair, i);
    if (!pair.hasErrors() && std::isfinite(values[i]))
      scale = std::max(scale, std::abs(values[i]));
  }
  if (scale > 0.0)
    for (double& value : values)
      value /= scale;
  return values;
}

Rgb divergingColor(double t) {
  if (!std::isfinite(t))
    return Rgb::Zero();
  const double fade = 1.0 - std::min(std::abs(t), 1.0);
  return t > 0.0 ? Rgb(1.0, fade, fade) : Rgb(fade, fade, 1.0);
}

} // namespace

Planes findPlanes(const Image& image, const std::array<const char*, 3>& names) {
  return {image.find(names[0]), image.find(names[1]), image.find(names[2])};
}

Planes findColors(const Image& image) {
  const Planes planes = findPlanes(image, colorNames);
  if (!isComplete(planes))
    throw inputError("images", "one has no channels R, G and B; compare color images");
  return planes;
}

void requireSameSize(const Image& a, const Image& b) {
  if (a.width != b.width || a.height != b.height)
    throw inputError("images", "have different sizes, " + formatSize(a) + " and " + formatSize(b) +
                                   "; compare images of the same size");
}

Comparison compareImages(const Image& a, const Image& b) {
  const ImagePair pair(a, b);
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
    result.z = computeZStatistics(pair, a.width);
  return result;
}

Image differenceImage(const Image& a, const Image& b) {
  const ImagePair pair(a, b);
  const std::vector<double> values = computeDifferences(pair);
  Image image{a.width, a.height, {}, {}};
  for (std::size_t c = 0; c < 3; ++c) {
    auto& plane = image.channels[colorNames[c]];
    plane.resize(pair.pixels);
    for (std::size_t i = 0; i < pair.pixels; ++i)
      plane[i] = static_cast<float>(divergingColor(values[i])[static_cast<int>(c)]);
  }
  return image;
}

void attachError(Image& image, const Image& error) {
  requireSameSize(image, error);
  const Planes planes = findColors(error);
  for (std::size_t c = 0; c < 3; ++c)
    image.channels[errorNames[c]] = *planes[c];
}

} // namespace fenestra::core
