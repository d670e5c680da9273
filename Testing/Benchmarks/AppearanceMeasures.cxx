#include "AppearanceMeasures.h"

#include "base/Color.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <numeric>

namespace fenestra::core::benchmarks {
namespace {

constexpr std::size_t leastCount = 100; // pixels of a statistic

template <typename Visitor>
void forEachPixel(const PixelMask& mask, const Visitor& visit) {
  for (int row = 0; row < mask.height; ++row)
    for (int column = 0; column < mask.width; ++column)
      if (mask.at(column, row) != 0)
        visit(column, row);
}

PixelMask invert(PixelMask mask) {
  for (std::uint8_t& value : mask.values)
    value = 1 - value;
  return mask;
}

/// Values per offset from -radius to radius.
using Kernel = std::vector<double>;

/// Gaussian of `sigma` pixels, times (offset * pitch)^power, normalized for power 0.
Kernel makeKernel(double sigma, int power, double pitch) {
  const int radius = static_cast<int>(std::ceil(3.0 * sigma));
  Kernel kernel, weights;
  for (int i = -radius; i <= radius; ++i) {
    weights.push_back(std::exp(-0.5 * i * i / (sigma * sigma)));
    kernel.push_back(weights.back() * std::pow(i * pitch, power));
  }
  const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
  for (double& value : kernel)
    value /= sum;
  return kernel;
}

/// Sums of values * kernel(offset) along one axis; values outside the image are 0.
Raster<double> correlateAxis(const Raster<double>& values, const Kernel& kernel, int dx, int dy) {
  Raster<double> sums(values.width, values.height);
  const int radius = static_cast<int>(kernel.size() / 2);
  tbb::parallel_for(0, values.height, [&](int row) {
    for (int column = 0; column < values.width; ++column) {
      double sum = 0.0;
      for (int i = -radius; i <= radius; ++i)
        if (values.contains(column + i * dx, row + i * dy))
          sum += kernel[static_cast<std::size_t>(i + radius)] *
                 values.at(column + i * dx, row + i * dy);
      sums.at(column, row) = sum;
    }
  });
  return sums;
}

Raster<double> correlate(const Raster<double>& values, const Kernel& alongX, const Kernel& alongY) {
  return correlateAxis(correlateAxis(values, alongX, 1, 0), alongY, 0, 1);
}

/// Values inside the mask, 0 outside.
Raster<double> selectValues(const Raster<double>& values, const PixelMask& mask) {
  Raster<double> selected(mask.width, mask.height);
  forEachPixel(mask,
               [&](int column, int row) { selected.at(column, row) = values.at(column, row); });
  return selected;
}

/// Values of the pixels in a square of 2 radius + 1 pixels, as far as image and mask have them.
std::vector<double> collectSquare(const Raster<double>& values, const PixelMask* mask, int column,
                                  int row, int radius) {
  std::vector<double> found;
  for (int y = std::max(0, row - radius); y <= std::min(values.height - 1, row + radius); ++y)
    for (int x = std::max(0, column - radius); x <= std::min(values.width - 1, column + radius);
         ++x)
      if (!mask || mask->at(x, y) != 0)
        found.push_back(values.at(x, y));
  return found;
}

/// The element of this rank, from 0; the fraction `p` of the last rank.
double selectRank(std::vector<double> values, double p) {
  const auto rank = static_cast<std::ptrdiff_t>(p * static_cast<double>(values.size()));
  std::ranges::nth_element(values, values.begin() + rank);
  return values[static_cast<std::size_t>(rank)];
}

Raster<double> filterMedian(const Raster<double>& values, const PixelMask& mask) {
  Raster<double> filtered(values.width, values.height);
  forEachPixel(mask, [&](int column, int row) {
    filtered.at(column, row) = selectRank(collectSquare(values, &mask, column, row, 1), 0.5);
  });
  return filtered;
}

/// Slopes, mm per mm, of planes fitted around each pixel with Gaussian weights.
class PlaneFit {
public:
  PlaneFit(const Raster<double>& depth, const PixelMask& mask, double sigma, double pitch)
      : m_depth(selectValues(depth, mask)), m_mask(mask.width, mask.height) {
    forEachPixel(mask, [&](int column, int row) { m_mask.at(column, row) = 1.0; });
    for (int power = 0; power <= 2; ++power)
      m_kernels.push_back(makeKernel(sigma, power, pitch));
    for (const auto& [x, y] : {std::pair(0, 0), {1, 0}, {0, 1}, {2, 0}, {1, 1}, {0, 2}})
      m_moments.push_back(correlate(m_mask, m_kernels[index(x)], m_kernels[index(y)]));
    for (const auto& [x, y] : {std::pair(0, 0), {1, 0}, {0, 1}})
      m_depthMoments.push_back(correlate(m_depth, m_kernels[index(x)], m_kernels[index(y)]));
  }

  Vec2 slope(int column, int row) const {
    const double weight = m_moments[0].at(column, row);
    const auto mean = [&](const Raster<double>& moment) { return moment.at(column, row) / weight; };
    const double x = mean(m_moments[1]), y = mean(m_moments[2]), z = mean(m_depthMoments[0]);
    const double xx = mean(m_moments[3]) - x * x, xy = mean(m_moments[4]) - x * y;
    const double yy = mean(m_moments[5]) - y * y;
    const double xz = mean(m_depthMoments[1]) - x * z, yz = mean(m_depthMoments[2]) - y * z;
    return Vec2(xz * yy - yz * xy, yz * xx - xz * xy) / (xx * yy - xy * xy);
  }

private:
  static std::size_t index(int power) { return static_cast<std::size_t>(power); }

  Raster<double> m_depth, m_mask;
  std::vector<Kernel> m_kernels;
  std::vector<Raster<double>> m_moments, m_depthMoments;
};

double angleBetween(const Vec2& a, const Vec2& b) {
  const Vec3 p(-a.x(), -a.y(), 1.0), q(-b.x(), -b.y(), 1.0);
  return std::atan2(p.cross(q).norm(), p.dot(q)) * 180.0 / pi;
}

Raster<double> transformValues(const Raster<Lab>& image, double (*transform)(const Lab&)) {
  Raster<double> values(image.width, image.height);
  std::ranges::transform(image.values, values.values.begin(), transform);
  return values;
}

Raster<double> lightness(const Raster<Lab>& image) {
  return transformValues(image, [](const Lab& lab) { return lab.L; });
}

Raster<double> chroma(const Raster<Lab>& image) {
  return transformValues(image, [](const Lab& lab) { return std::hypot(lab.a, lab.b); });
}

/// Fraction of the mask's pixels that pass the test; empty without pixels.
template <typename Test>
std::optional<double> fraction(const PixelMask& mask, const Test& test) {
  std::vector<std::size_t> counts(static_cast<std::size_t>(mask.height));
  tbb::parallel_for(0, mask.height, [&](int row) {
    for (int column = 0; column < mask.width; ++column)
      if (mask.at(column, row) != 0 && test(column, row))
        ++counts[static_cast<std::size_t>(row)];
  });
  const std::size_t all = countPixels(mask);
  if (all == 0)
    return std::nullopt;
  return static_cast<double>(std::accumulate(counts.begin(), counts.end(), std::size_t{0})) /
         static_cast<double>(all);
}

} // namespace

std::size_t countPixels(const PixelMask& mask) {
  return static_cast<std::size_t>(std::ranges::count(mask.values, 1));
}

PixelMask intersect(PixelMask a, const PixelMask& b) {
  std::ranges::transform(a.values, b.values, a.values.begin(), std::bit_and());
  return a;
}

PixelMask subtract(PixelMask a, const PixelMask& b) {
  return intersect(std::move(a), invert(b));
}

PixelMask dilate(const PixelMask& mask, double radius) {
  PixelMask result = mask;
  const int reach = static_cast<int>(radius);
  const auto isOutside = [&](int column, int row) {
    return mask.contains(column, row) && mask.at(column, row) == 0;
  };
  forEachPixel(mask, [&](int column, int row) {
    if (!isOutside(column - 1, row) && !isOutside(column + 1, row) && !isOutside(column, row - 1) &&
        !isOutside(column, row + 1))
      return;
    for (int y = -reach; y <= reach; ++y)
      for (int x = -reach; x <= reach; ++x)
        if (std::hypot(x, y) <= radius && mask.contains(column + x, row + y))
          result.at(column + x, row + y) = 1;
  });
  return result;
}

PixelMask erode(const PixelMask& mask, double radius) {
  return invert(dilate(invert(mask), radius));
}

PixelMask findJumps(const Raster<double>& depth, double step) {
  PixelMask jumps(depth.width, depth.height);
  const auto compare = [&](int column, int row, int nextColumn, int nextRow) {
    if (!depth.contains(nextColumn, nextRow))
      return;
    const double from = depth.at(column, row), to = depth.at(nextColumn, nextRow);
    if (from != to && !(std::abs(from - to) <= step))
      jumps.at(column, row) = jumps.at(nextColumn, nextRow) = 1;
  };
  for (int row = 0; row < depth.height; ++row)
    for (int column = 0; column < depth.width; ++column) {
      compare(column, row, column + 1, row);
      compare(column, row, column, row + 1);
    }
  return jumps;
}

double quantile(std::vector<double> values, double p) {
  if (values.empty())
    return std::numeric_limits<double>::quiet_NaN();
  std::ranges::sort(values);
  const double rank = p * static_cast<double>(values.size() - 1);
  const auto low = static_cast<std::size_t>(rank);
  const std::size_t high = std::min(low + 1, values.size() - 1);
  return values[low] + (values[high] - values[low]) * (rank - static_cast<double>(low));
}

Raster<Lab> toLabRaster(const Raster<Rgb>& display) {
  Raster<Lab> image(display.width, display.height);
  std::ranges::transform(display.values, image.values.begin(),
                         [](const Rgb& color) { return toLab(decodeSrgb(color)); });
  return image;
}

std::optional<AngleSpread> measureStairs(const Raster<double>& depth, const PixelMask& focus,
                                         double pitch) {
  constexpr double sigma = 4.0, jump = 5.0;
  const Raster<double> filtered = filterMedian(depth, focus);
  const PlaneFit fit(filtered, focus, sigma / pitch, pitch);
  // Outside the focus depths are 0, so that its outline is a jump, too: count only jumps inside.
  const PixelMask jumps = intersect(findJumps(filtered, jump), erode(focus, 1.0));
  const PixelMask counted =
      subtract(erode(focus, sigma / pitch), dilate(jumps, 3.0 * sigma / pitch));
  std::vector<double> angles;
  double squares = 0.0;
  forEachPixel(counted, [&](int column, int row) {
    if (column == 0 || row == 0 || column + 1 == depth.width || row + 1 == depth.height)
      return;
    const Vec2 slope(filtered.at(column + 1, row) - filtered.at(column - 1, row),
                     filtered.at(column, row + 1) - filtered.at(column, row - 1));
    angles.push_back(angleBetween(slope / (2.0 * pitch), fit.slope(column, row)));
    squares += angles.back() * angles.back();
  });
  if (angles.size() < leastCount)
    return std::nullopt;
  return AngleSpread{std::sqrt(squares / static_cast<double>(angles.size())),
                     quantile(angles, 0.95)};
}

std::optional<double> measureMottle(const Raster<Lab>& image, const PixelMask& region,
                                    double pitch) {
  const Kernel kernel = makeKernel(3.0 / pitch, 0, pitch);
  const auto blur = [&](double (*component)(const Lab&)) {
    return correlate(selectValues(transformValues(image, component), region), kernel, kernel);
  };
  const Raster<double> weight = correlate(
      selectValues(Raster<double>(image.width, image.height, 1.0), region), kernel, kernel);
  const Raster<double> L = blur([](const Lab& lab) { return lab.L; });
  const Raster<double> a = blur([](const Lab& lab) { return lab.a; });
  const Raster<double> b = blur([](const Lab& lab) { return lab.b; });
  double squares = 0.0;
  std::size_t count = 0;
  forEachPixel(region, [&](int column, int row) {
    const double w = weight.at(column, row);
    if (w < 0.5)
      return;
    const Lab mean = {L.at(column, row) / w, a.at(column, row) / w, b.at(column, row) / w};
    const double difference = deltaE76(image.at(column, row), mean);
    squares += difference * difference;
    ++count;
  });
  if (count < leastCount)
    return std::nullopt;
  return std::sqrt(squares / static_cast<double>(count));
}

Tone measureTone(const Raster<Lab>& image, const PixelMask& covered) {
  constexpr double shadow = 14.0;
  std::vector<double> lightnesses, chromas;
  forEachPixel(covered, [&](int column, int row) {
    const Lab& lab = image.at(column, row);
    if (lab.L > shadow) {
      lightnesses.push_back(lab.L);
      chromas.push_back(std::hypot(lab.a, lab.b));
    }
  });
  return {quantile(lightnesses, 0.05), quantile(lightnesses, 0.5), quantile(lightnesses, 0.95),
          quantile(chromas, 0.5), quantile(chromas, 0.95)};
}

std::optional<double> measureHighlights(const Raster<Lab>& image, const PixelMask& focus,
                                        double pitch) {
  const int radius = static_cast<int>(std::lround(10.0 / pitch - 0.5));
  const Raster<double> L = lightness(image), C = chroma(image);
  const auto median = [radius](const Raster<double>& values, int column, int row) {
    return selectRank(collectSquare(values, nullptr, column, row, radius), 0.5);
  };
  return fraction(erode(focus, 6.0 / pitch), [&](int column, int row) {
    return L.at(column, row) - median(L, column, row) > 6.0 &&
           C.at(column, row) < median(C, column, row);
  });
}

std::optional<double> measureDarkEdge(const Raster<Lab>& image, const PixelMask& focus) {
  const PixelMask opened = dilate(erode(focus, 2.0), 2.0);
  const PixelMask band = subtract(dilate(opened, 3.0), erode(opened, 3.0));
  const Raster<double> L = lightness(image);
  return fraction(band, [&](int column, int row) {
    return selectRank(collectSquare(L, nullptr, column, row, 7), 0.3) - L.at(column, row) > 10.0;
  });
}

std::optional<EdgeContrast> measureContrast(const Raster<Rgb>& display, const PixelMask& focus,
                                            const PixelMask& covered) {
  constexpr double nearest = 3.0, farthest = 8.0;
  const auto findBand = [&](const PixelMask& side) {
    const PixelMask other = invert(side);
    return intersect(subtract(dilate(other, farthest), dilate(other, nearest - 0.01)), covered);
  };
  const PixelMask inside = findBand(focus), outside = findBand(invert(focus));
  if (countPixels(inside) == 0 || countPixels(outside) == 0)
    return std::nullopt;
  const auto findMean = [&](const PixelMask& mask) -> Rgb {
    Rgb sum = Rgb::Zero();
    forEachPixel(mask, [&](int column, int row) { sum += display.at(column, row); });
    return decodeSrgb(sum / static_cast<double>(countPixels(mask)));
  };
  const Rgb a = findMean(inside), b = findMean(outside);
  const auto difference = [&](ColorVision vision) {
    return deltaE76(toLab(simulateVision(vision, a)), toLab(simulateVision(vision, b)));
  };
  return EdgeContrast{difference(ColorVision::normal),
                      difference(ColorVision::protan),
                      difference(ColorVision::deutan),
                      std::abs(toLab(a).L - toLab(b).L),
                      toLab(a),
                      toLab(b)};
}

} // namespace fenestra::core::benchmarks
