// Makes the table of the reflectance of a thick scattering medium for
// Renderer/model/medium/Reflectance.cxx:
//
//     MakeReflectance > Renderer/model/medium/ReflectanceTable.h
//
// Photons enter a half-space of unit extinction along its normal and scatter without loss until
// they leave. A photon that leaves after n scatterings contributes albedo^n, so one simulation
// serves all albedos. By reciprocity the sum is the radiance seen along the normal under uniform
// light of radiance 1.

#include "Scatter.h"
#include "model/medium/Reflectance.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstdio>
#include <functional>
#include <mutex>
#include <vector>

namespace {

using fenestra::maxReflectanceG;
using fenestra::oracle::Generator;
using fenestra::oracle::uniform;

constexpr int rows = 16, columns = 32;
constexpr int photons = 1 << 20, parts = 64;
constexpr double maxFollowed = 500.0; ///< maximum number of scatterings, times 1 - g

/// Albedo for similarity parameter s = sqrt((1 - a) / (1 - g a)).
double computeAlbedo(double s, double g) {
  return (1.0 - s * s) / (1.0 - g * s * s);
}

/// Cosine of the scattering angle by inversion of Henyey and Greenstein (1941).
double sampleCosine(double g, double u) {
  if (g == 0.0)
    return 2.0 * u - 1.0;
  const double t = (1.0 - g * g) / (1.0 - g + 2.0 * g * u);
  return (1.0 + g * g - t * t) / (2.0 * g);
}

/// Number of scatterings until a photon leaves; `most` if it is still inside.
int countScatterings(double g, int most, Generator& generator) {
  double depth = 0.0, down = 1.0; // down: cosine to the inner normal
  for (int n = 0; n < most; ++n) {
    depth -= std::log1p(-uniform(generator)) * down;
    if (depth < 0.0)
      return n;
    const double cosine = sampleCosine(g, uniform(generator));
    const double azimuth = 2.0 * fenestra::pi * uniform(generator);
    const double sines = std::sqrt(std::max(0.0, (1.0 - cosine * cosine) * (1.0 - down * down)));
    down = std::clamp(down * cosine + sines * std::cos(azimuth), -1.0, 1.0);
  }
  return most;
}

/// Mean of albedo^n over photons still inside after `most` scatterings. From there on their exits
/// follow the first return of a random walk, of density n^(-3/2).
double findTailMean(double albedo, int most) {
  const double x = -std::log(albedo) * most;
  return std::exp(-x) - std::sqrt(fenestra::pi * x) * std::erfc(std::sqrt(x));
}

using Counts = std::vector<double>;

/// Fraction of photons by the number of scatterings before they leave; last: those still inside.
Counts simulateEscapes(double g, std::uint64_t seed) {
  const int most = static_cast<int>(maxFollowed / (1.0 - g));
  Counts fractions(static_cast<std::size_t>(most) + 1);
  std::mutex mutex;
  tbb::parallel_for(0, parts, [&](int part) {
    Generator generator(seed * parts + static_cast<std::uint64_t>(part));
    Counts own(fractions.size());
    for (int photon = 0; photon < photons / parts; ++photon)
      own[static_cast<std::size_t>(countScatterings(g, most, generator))] += 1.0 / photons;
    const std::lock_guard lock(mutex);
    std::ranges::transform(fractions, own, fractions.begin(), std::plus());
  });
  return fractions;
}

double reflectance(const Counts& fractions, double albedo) {
  double sum = fractions.back() * findTailMean(albedo, static_cast<int>(fractions.size()) - 1);
  for (std::size_t n = 1; n + 1 < fractions.size(); ++n)
    sum += fractions[n] * std::pow(albedo, static_cast<double>(n));
  return sum;
}

} // namespace

int main() {
  std::puts(
      "#pragma once\n"
      "// Made by Testing/Oracle/MakeReflectance.cxx. Rows: g from 0 to greatestColorG; columns: "
      "s from 0\n"
      "// to 1; values: reflectance / ((1 - s) / (1 + 2 s)).\n\n"
      "namespace fenestra::seen {\n");
  std::printf("inline constexpr int rows = %d, columns = %d;\n"
              "inline constexpr float ratios[rows][columns] = {\n",
              rows, columns);
  for (int r = 0; r < rows; ++r) {
    const double g = maxReflectanceG * r / (rows - 1.0);
    const Counts fractions = simulateEscapes(g, static_cast<std::uint64_t>(r) + 1);
    std::printf("    {");
    for (int c = 0; c < columns; ++c) {
      const double s = c / (columns - 1.0);
      double ratio = 1.0;   // s = 0: all photons leave
      if (c == columns - 1) // limit of small albedo a: one scattering, and 1 - s = (1 - g) a / 2
        ratio = 6.0 * fractions[1] / (1.0 - g);
      else if (c > 0)
        ratio = reflectance(fractions, computeAlbedo(s, g)) * (1.0 + 2.0 * s) / (1.0 - s);
      std::printf("%.4fF%s", ratio, c + 1 < columns ? ", " : "");
    }
    std::puts(r + 1 < rows ? "}," : "}};");
    std::fflush(stdout);
  }
  std::puts("\n} // namespace fenestra::seen");
}
