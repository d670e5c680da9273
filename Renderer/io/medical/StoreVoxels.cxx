#include "io/medical/StoreVoxels.h"

#include "core/Error.h"

#include <utility>

namespace fenestra {
namespace {

/// What the samples are, as far as it decides how to store them.
template <typename T>
struct Survey {
  T least = std::numeric_limits<T>::max(); ///< of the finite ones
  T greatest = std::numeric_limits<T>::lowest();
  bool whole = true; ///< the finite ones are whole numbers
  std::size_t notANumber = 0, infinite = 0;

  bool finite() const { return notANumber + infinite == 0; }
};

template <typename T>
Survey<T> survey(const std::vector<T>& samples) {
  Survey<T> s;
  for (const T x : samples) {
    if constexpr (std::is_floating_point_v<T>) {
      if (!std::isfinite(x)) {
        ++(std::isnan(x) ? s.notANumber : s.infinite);
        continue;
      }
      s.whole = s.whole && x == std::trunc(x);
    }
    s.least = std::min(s.least, x);
    s.greatest = std::max(s.greatest, x);
  }
  return s;
}

template <typename Stored, typename T>
bool fits(const Survey<T>& s) {
  using Limits = std::numeric_limits<Stored>;
  if constexpr (std::is_integral_v<T>)
    return std::cmp_greater_equal(s.least, Limits::min()) &&
           std::cmp_less_equal(s.greatest, Limits::max());
  else
    return s.whole && s.least >= static_cast<T>(Limits::min()) &&
           s.greatest <= static_cast<T>(Limits::max());
}

/// Takes the place of a sample that is not finite.
template <typename T>
T mended(T x, const Survey<T>& s) {
  if constexpr (std::is_floating_point_v<T>) {
    if (x > s.greatest)
      return s.greatest;
    return x >= s.least ? x : s.least; // NaN as well
  }
  return x;
}

/// Doubles beyond float's range take its ends.
template <typename Stored, typename T>
Stored stored(T x) {
  if constexpr (std::is_same_v<T, double> && std::is_same_v<Stored, float>) {
    constexpr double most = std::numeric_limits<float>::max();
    return static_cast<float>(std::clamp(x, -most, most));
  }
  return static_cast<Stored>(x);
}

template <typename Stored, typename T>
Voxels store(std::vector<T>&& samples, const Survey<T>& s) {
  if constexpr (std::is_same_v<Stored, T>) {
    if (!s.finite())
      for (T& x : samples)
        x = mended(x, s);
    return std::move(samples);
  } else {
    std::vector<Stored> voxels(samples.size());
    std::transform(samples.begin(), samples.end(), voxels.begin(),
                   [&s](T x) { return stored<Stored>(mended(x, s)); });
    return voxels;
  }
}

template <typename T>
Voxels storeSmallest(std::vector<T>&& samples, const Survey<T>& s) {
  if (fits<std::uint8_t>(s))
    return store<std::uint8_t>(std::move(samples), s);
  if (fits<std::int16_t>(s))
    return store<std::int16_t>(std::move(samples), s);
  if (fits<std::uint16_t>(s))
    return store<std::uint16_t>(std::move(samples), s);
  return store<float>(std::move(samples), s);
}

template <typename T>
void warn(const Survey<T>& s, Volume& volume) {
  const auto line = [&volume](std::size_t count, const char* what, const char* replacement) {
    if (count > 0)
      volume.warnings.push_back(volume.name + ": " + std::to_string(count) + " voxels are " + what +
                                " and count as " + replacement);
  };
  line(s.notANumber, "not a number", "the least finite value");
  line(s.infinite, "infinite", "the least or greatest finite value");
}

template <typename T>
void fill(std::vector<T>&& samples, Volume& volume) {
  const Survey<T> s = survey(samples);
  if (s.notANumber + s.infinite == samples.size())
    throw inputError(volume.name, "no voxel is a finite number; write it again");
  warn(s, volume);
  volume.voxels = storeSmallest(std::move(samples), s);
}

} // namespace

Volume makeVolume(std::string name, const Grid& grid, Samples&& samples) {
  Volume volume;
  volume.grid = grid;
  volume.name = std::move(name);
  std::visit([&volume](auto& values) { fill(std::move(values), volume); }, samples);
  computeRange(volume);
  return volume;
}

} // namespace fenestra
