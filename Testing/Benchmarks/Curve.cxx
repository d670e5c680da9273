#include "Curve.h"

#include "Agreement.h"
#include "Program.h"
#include "image/Compare.h"

#include <algorithm>
#include <numeric>

namespace fenestra::core::benchmarks {
namespace {

/// Measurements from one render.
struct Sample {
  double cpuSeconds, relMse;
  double bias, ownError, referenceError; ///< of the image mean, relative to the reference's
};

Sample measure(const Mode& mode, const PreparedScene& scene, const RenderSettings& settings,
               const Image& reference) {
  const double before = cpuSeconds();
  const Film film = mode.render(scene.view(), settings);
  const double seconds = cpuSeconds() - before;
  const Image image = toImage(film, scene);

  // One tile covers the image. The channels of a path are correlated, so the error of their mean is
  // at most the mean of their errors.
  const int size = std::max(image.width, image.height);
  const Image mean = computeTileMeans(image, size),
              referenceMean = computeTileMeans(reference, size);
  Sample sample{seconds, compareImages(image, reference).relMse, 0.0, 0.0, 0.0};
  for (const std::string channel : {"R", "G", "B"}) {
    const double scale = 1.0 / (3.0 * referenceMean.find(channel)->front());
    sample.bias += scale * (mean.find(channel)->front() - referenceMean.find(channel)->front());
    sample.ownError += scale * mean.find("error." + channel)->front();
    sample.referenceError += scale * referenceMean.find("error." + channel)->front();
  }
  return sample;
}

Point summarize(std::uint64_t samples, const std::vector<Sample>& renders) {
  const auto n = static_cast<double>(renders.size());
  const auto mean = [&](auto field) {
    return std::transform_reduce(renders.begin(), renders.end(), 0.0, std::plus<>(), field) / n;
  };
  Point point{.samples = samples, .seeds = static_cast<int>(renders.size())};
  point.cpuSeconds = mean([](const Sample& s) { return s.cpuSeconds; });
  point.relMse = mean([](const Sample& s) { return s.relMse; });
  point.bias = mean([](const Sample& s) { return s.bias; });
  // All seeds share the reference's error.
  point.biasError = std::hypot(mean([](const Sample& s) { return s.ownError; }) / std::sqrt(n),
                               renders.front().referenceError);
  if (renders.size() > 1)
    point.spread =
        std::sqrt(mean([&](const Sample& s) { return std::pow(s.relMse - point.relMse, 2.0); }) *
                  n / (n - 1.0));
  return point;
}

} // namespace

std::vector<Point> measureCurve(const Mode& mode, const PreparedScene& scene,
                                const RenderSettings& settings, const Image& reference,
                                const CurveSettings& limits) {
  std::vector<Point> curve;
  double total = 0.0;
  RenderSettings pointSettings = settings;
  for (pointSettings.samples = limits.samples;; pointSettings.samples *= 2) {
    std::vector<Sample> renders;
    const auto fitsBudget = [&](double seconds) { return total + seconds <= limits.budget; };
    if (!curve.empty() && !fitsBudget(2.0 * curve.back().cpuSeconds))
      return curve;
    for (int seed = 0; seed < limits.seeds; ++seed) {
      pointSettings.seed = static_cast<std::uint64_t>(seed);
      renders.push_back(measure(mode, scene, pointSettings, reference));
      total += renders.back().cpuSeconds;
      if (!fitsBudget(renders.back().cpuSeconds))
        break;
    }
    curve.push_back(summarize(pointSettings.samples, renders));
    if (curve.back().relMse < limits.leastRelMse)
      return curve;
  }
}

std::optional<Efficiency> findEfficiency(const std::vector<Point>& curve, double relMse) {
  const double target = std::log(relMse);
  const Point* last = nullptr;
  std::optional<Efficiency> nearest;
  for (const Point& point : curve) {
    if (!(point.relMse > 0.0))
      continue;
    if (last && last->relMse >= relMse && point.relMse < relMse) {
      const double fraction =
          (target - std::log(last->relMse)) / std::log(point.relMse / last->relMse);
      const double seconds =
          last->cpuSeconds * std::pow(point.cpuSeconds / last->cpuSeconds, fraction);
      return Efficiency{1.0 / (relMse * seconds), relMse};
    }
    if (!nearest ||
        std::abs(std::log(point.relMse) - target) < std::abs(std::log(nearest->relMse) - target))
      nearest = Efficiency{point.efficiency(), point.relMse};
    last = &point;
  }
  return nearest;
}

} // namespace fenestra::core::benchmarks
