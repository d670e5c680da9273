#pragma once
// Random numbers as a function of (seed, pixel, sample), independent of the order of samples and
// of the number of threads.

#include "base/Vector.h"

#include <cstdint>

namespace fenestra::core {

/// Bit mixer with full avalanche (Stafford's variant 13 of MurmurHash3's finalizer).
constexpr std::uint64_t mixBits(std::uint64_t x) {
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ULL;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebULL;
  return x ^ (x >> 31);
}

/// Random bits to a uniform number in [0, 1); the largest value is 1 - 2^-53.
constexpr double toUniform(std::uint64_t bits) {
  return static_cast<double>(bits >> 11) * 0x1p-53;
}

/// Two uniform numbers of 32 bits each.
inline Vec2 toUniform2(std::uint64_t bits) {
  return {static_cast<double>(bits >> 32) * 0x1p-32,
          static_cast<double>(bits & 0xffffffffU) * 0x1p-32};
}

/// Uniform number in [0, 1) to an exponential variate of mean 1; always finite.
inline double toExponential(double uniform) {
  return -std::log1p(-uniform);
}

/// SplitMix64 (Steele, Lea, Flood 2014), seeded with a hash of its coordinates.
class Random {
public:
  /// Increment of the state: the odd integer nearest to 2^64 / golden ratio.
  static constexpr std::uint64_t gamma = 0x9e3779b97f4a7c15ULL;

  Random(std::uint64_t seed, std::uint64_t pixel, std::uint64_t sample)
      : m_state(mixBits(mixBits(mixBits(seed + gamma) ^ (pixel + gamma)) ^ (sample + gamma))) {}
  /// Starts from random bits.
  explicit Random(std::uint64_t start) : m_state(start) {}

  std::uint64_t bits() { return mixBits(m_state += gamma); }

  double uniform() { return toUniform(bits()); }
  Vec2 uniform2() {
    const double u = uniform();
    return {u, uniform()};
  }

  double exponential() { return toExponential(uniform()); }

private:
  std::uint64_t m_state;
};

/// Uniform on the unit sphere.
inline Vec3 sampleUniformSphere(const Vec2& u) {
  const double z = 1.0 - 2.0 * u.x();
  const double r = std::sqrt(std::max(0.0, 1.0 - z * z));
  return {r * std::cos(2.0 * pi * u.y()), r * std::sin(2.0 * pi * u.y()), z};
}

} // namespace fenestra::core
