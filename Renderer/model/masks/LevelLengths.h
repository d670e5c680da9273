#pragma once
// Lengths of lines inside a surface for every level, the voxel value that defines the surface.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>

namespace fenestra::core {

/// A function of voxel values, which keeps 0 and 255. It does not decrease.
using VoxelValues = std::array<std::uint8_t, 256>;

/// Lengths inside a surface of lines of one voxel, as a function of the level. Values are linear on
/// a line. Levels and values are in steps of a quarter.
class LevelLengths {
public:
  static constexpr std::int64_t unit = 1 << 24; ///< length of a line
  static constexpr int steps = 4;               ///< per voxel value
  static constexpr int maxValue = 255 * steps;

  /// Range of levels whose lengths are exact. A line outside it needs no distribution over levels.
  struct Levels {
    int first, last;
  };
  static constexpr Levels allLevels{0, maxValue};

  explicit LevelLengths(const Levels& levels) : m_levels(levels) {}

  const Levels& levels() const { return m_levels; }

  /// Distributes a line evenly over the levels from `begin` to `end`.
  void addLine(int begin, int end) {
    const std::int64_t density = (*m_densities)[static_cast<std::size_t>(end - begin)];
    m_changes[static_cast<std::size_t>(begin)] += density;
    m_changes[static_cast<std::size_t>(end)] -= density;
  }

  /// Adds length inside at all levels.
  void addInside(std::int64_t length) { m_alwaysInside += length; }

  void add(const LevelLengths& more) {
    std::ranges::transform(m_changes, more.m_changes, m_changes.begin(), std::plus());
    m_alwaysInside += more.m_alwaysInside;
  }

  /// True if findLevel() is exact: the length is reached within the range of levels.
  bool hasLevel(std::int64_t length) const {
    const Lengths lengths = integrate();
    const auto at = [&](int level) { return lengths[static_cast<std::size_t>(level)]; };
    return at(m_levels.first) > length && at(m_levels.last) < length;
  }

  /// Level at which the length is `length`: the middle if it is so for a range of levels.
  double findLevel(std::int64_t length) const {
    const Lengths lengths = integrate();
    double highest = 0.0, lowest = maxValue;
    for (std::size_t level = 0; level < maxValue; ++level) {
      const std::int64_t here = lengths[level], next = lengths[level + 1];
      const auto at = static_cast<double>(level);
      const double fraction =
          here == next ? 0.0
                       : static_cast<double>(here - length) / static_cast<double>(here - next);
      if (here >= length)
        highest = here == next ? at + 1.0 : at + std::min(fraction, 1.0);
      if (next <= length && lowest == maxValue)
        lowest = at + std::clamp(fraction, 0.0, 1.0);
    }
    return 0.5 * (lowest + highest) / steps;
  }

  /// Length inside for a level, in lines.
  double findLength(double level) const {
    const Lengths lengths = integrate();
    const auto below = static_cast<std::size_t>(level * steps);
    const double fraction = level * steps - static_cast<double>(below);
    return (static_cast<double>(lengths[below]) * (1.0 - fraction) +
            static_cast<double>(lengths[below + 1]) * fraction) /
           static_cast<double>(unit);
  }

private:
  using Lengths = std::array<std::int64_t, maxValue + 1>; ///< per step

  /// Density of a line over 0 (unused), 1, 2, ... steps, to avoid a division per line.
  static const Lengths& findDensities() {
    static const Lengths all = [] {
      Lengths result{};
      for (std::int64_t length = 1; length <= maxValue; ++length)
        result[static_cast<std::size_t>(length)] = unit / length;
      return result;
    }();
    return all;
  }

  /// Length inside for each level.
  Lengths integrate() const {
    Lengths densities{}, lengths{};
    std::int64_t density = 0;
    for (std::size_t level = 0; level < maxValue; ++level)
      densities[level] = density += m_changes[level];
    lengths[maxValue] = m_alwaysInside;
    for (std::size_t level = maxValue; level-- > 0;)
      lengths[level] = lengths[level + 1] + densities[level];
    return lengths;
  }

  Levels m_levels;
  const Lengths* m_densities = &findDensities();
  Lengths m_changes{}; ///< of the density of lengths
  std::int64_t m_alwaysInside = 0;
};

} // namespace fenestra::core
