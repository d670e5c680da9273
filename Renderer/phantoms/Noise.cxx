#include "phantoms/Noise.h"

#include "base/Random.h"

#include <array>
#include <limits>

namespace fenestra::core {

namespace {

/// A cell of the lattice with the values at its corners, z varying fastest.
struct LatticeCell {
  Size3 lower = Size3::Constant(std::numeric_limits<std::int64_t>::min()); ///< of no cell
  std::uint64_t seed = 0;
  std::array<double, 8> values = {};
};

/// The cell above `lower`. Successive points mostly lie in the same one, so each thread keeps the
/// last cell of each field.
const LatticeCell& findCell(const Size3& lower, std::uint64_t seed) {
  thread_local std::array<LatticeCell, 512> cells;
  LatticeCell& cell = cells[seed % cells.size()];
  if (cell.lower == lower && cell.seed == seed)
    return cell;
  // Odd constants spread the coordinates over 64 bits before mixing.
  constexpr Vector<std::uint64_t, 3> spread{0x9e3779b97f4a7c15ULL, 0xc2b2ae3d27d4eb4fULL,
                                            0x165667b19e3779f9ULL};
  const std::uint64_t first = lower.cast<std::uint64_t>().dot(spread) + seed;
  for (std::uint64_t i = 0; i < cell.values.size(); ++i) {
    const std::uint64_t key =
        first + (i >> 2) * spread.x() + (i >> 1 & 1) * spread.y() + (i & 1) * spread.z();
    cell.values[i] = static_cast<double>(mixBits(key) >> 11) * 0x1p-52 - 1.0;
  }
  cell.lower = lower;
  cell.seed = seed;
  return cell;
}

/// Largest integer up to x; std::floor is a call of a library where SSE 4.1 may be missing.
std::int64_t floorToInteger(double x) {
  const auto truncated = static_cast<std::int64_t>(x);
  return truncated - (static_cast<double>(truncated) > x);
}

/// std::lerp for t from 0 to 1, without its branches, which random signs make slow: as
/// t * b + (1 - t) * a where the signs differ (or t is 1), and as t * (b - a) + a elsewhere.
double interpolate(double a, double b, double t) {
  const double differ = (a * b <= 0.0) | (t >= 1.0);
  const double value = t * (b - (1.0 - differ) * a) + (1.0 - differ * t) * a;
  return std::max(std::min(value, std::max(a, b)), std::min(a, b));
}

/// Interpolates between the first `half` values and the next.
template <std::size_t half>
void interpolate(std::array<double, 8>& values, double t) {
  for (std::size_t i = 0; i < half; ++i)
    values[i] = interpolate(values[i], values[i + half], t);
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
  const Size3 lower = point.unaryExpr(floorToInteger);
  const Vec3 f = point - lower.cast<double>();
  // Smoothstep: weights of the upper lattice points.
  const Vec3 s = f.array().square() * (3.0 - 2.0 * f.array());
  std::array<double, 8> values = findCell(lower, seed).values;
  interpolate<4>(values, s.x());
  interpolate<2>(values, s.y());
  interpolate<1>(values, s.z());
  return values[0];
}

double normalNoise(std::uint64_t voxel) {
  return normalPair(voxel).x();
}

double ricianNoise(double signal, double sigma, std::uint64_t voxel) {
  const Vec2 noise = sigma * normalPair(voxel);
  return std::hypot(signal + noise.x(), noise.y());
}

} // namespace fenestra::core
