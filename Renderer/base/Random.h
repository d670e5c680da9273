#pragma once
// Random numbers as a function of (seed, pixel, sample), independent of the order of samples and
// of the number of threads.

#include "base/Vector.h"

#include <cstdint>

namespace fenestra {

/// Bit mixer with full avalanche (Stafford's variant 13 of MurmurHash3's finaliser).
constexpr std::uint64_t mixBits(std::uint64_t x) {
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ULL;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebULL;
  return x ^ (x >> 31);
}

/// SplitMix64 (Steele, Lea, Flood 2014), started at a hash of its coordinates.
class Random {
public:
  /// Numbers of two samples of a pixel are independent.
  static constexpr bool hasIndependentSamples = true;

  Random(std::uint64_t seed, std::uint64_t pixel, std::uint64_t sample)
      : m_state(mixBits(mixBits(mixBits(seed + gamma) ^ (pixel + gamma)) ^ (sample + gamma))) {}

  std::uint64_t bits() { return mixBits(m_state += gamma); }

  /// Uniform in [0, 1): 0 occurs, the largest value is 1 - 2^-53.
  double uniform() { return static_cast<double>(bits() >> 11) * 0x1p-53; }
  Vec2 uniform2() {
    const double u = uniform();
    return {u, uniform()};
  }

  /// Exponential with mean 1; finite for every draw, 0 included.
  double exponential() { return -std::log1p(-uniform()); }

private:
  static constexpr std::uint64_t gamma = 0x9e3779b97f4a7c15ULL;
  std::uint64_t m_state;
};

/// Uniform on the unit sphere.
inline Vec3 uniformDirection(const Vec2& u) {
  const double z = 1.0 - 2.0 * u.x();
  const double r = std::sqrt(std::max(0.0, 1.0 - z * z));
  return {r * std::cos(2.0 * pi * u.y()), r * std::sin(2.0 * pi * u.y()), z};
}

} // namespace fenestra
