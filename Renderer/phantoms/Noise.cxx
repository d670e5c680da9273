#include "phantoms/Noise.h"

#include "base/Random.h"

namespace fenestra {

namespace {

double latticeValue(std::int64_t x, std::int64_t y, std::int64_t z, std::uint64_t seed) {
  // Odd constants spread the coordinates over 64 bits before mixing.
  const std::uint64_t key = static_cast<std::uint64_t>(x) * 0x9e3779b97f4a7c15ULL +
                            static_cast<std::uint64_t>(y) * 0xc2b2ae3d27d4eb4fULL +
                            static_cast<std::uint64_t>(z) * 0x165667b19e3779f9ULL + seed;
  return static_cast<double>(mixBits(key) >> 11) * 0x1p-52 - 1.0;
}

/// Two independent normal deviates (Box and Muller 1958).
Vec2 normalPair(std::uint64_t voxel) {
  Random random(0, voxel, 0);
  const double radius = std::sqrt(2.0 * random.exponential());
  const double angle = 2.0 * pi * random.uniform();
  return {radius * std::cos(angle), radius * std::sin(angle)};
}

} // namespace

double valueNoise(const Vec3& point, std::uint64_t seed) {
  const Vec3 floor = point.array().floor();
  const Vec3 f = point - floor;
  // Smoothstep: weights of the upper lattice points.
  const Vec3 s = f.array().square() * (3.0 - 2.0 * f.array());
  const auto x = static_cast<std::int64_t>(floor.x());
  const auto y = static_cast<std::int64_t>(floor.y());
  const auto z = static_cast<std::int64_t>(floor.z());
  const auto edge = [&](std::int64_t dy, std::int64_t dz) {
    return std::lerp(latticeValue(x, y + dy, z + dz, seed),
                     latticeValue(x + 1, y + dy, z + dz, seed), s.x());
  };
  return std::lerp(std::lerp(edge(0, 0), edge(1, 0), s.y()),
                   std::lerp(edge(0, 1), edge(1, 1), s.y()), s.z());
}

double normalNoise(std::uint64_t voxel) {
  return normalPair(voxel).x();
}

double ricianNoise(double signal, double sigma, std::uint64_t voxel) {
  const Vec2 noise = sigma * normalPair(voxel);
  return std::hypot(signal + noise.x(), noise.y());
}

} // namespace fenestra
