#pragma once
// Stores samples in the smallest type that holds all of them so far. The full volume therefore
// never exists in the file's wider type.

#include "base/LargePages.h"
#include "base/Vector.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

namespace fenestra::core {

/// Range and kind of samples. Doubles hold every 32-bit integer exactly.
struct SampleStats {
  double minimum = infinity, maximum = -infinity; ///< range of the finite samples
  bool isIntegral = true;                         ///< all finite samples are integers
  std::size_t nanCount = 0, infiniteCount = 0;

  bool isFinite() const { return nanCount + infiniteCount == 0; }

  void add(const SampleStats& more) {
    minimum = std::min(minimum, more.minimum);
    maximum = std::max(maximum, more.maximum);
    isIntegral = isIntegral && more.isIntegral;
    nanCount += more.nanCount;
    infiniteCount += more.infiniteCount;
  }
};

template <typename T>
SampleStats computeStats(std::span<const T> samples) {
  SampleStats s;
  T minimum = std::numeric_limits<T>::max();
  T maximum = std::numeric_limits<T>::lowest();
  for (const T x : samples) {
    if constexpr (std::is_floating_point_v<T>) {
      if (!std::isfinite(x)) {
        ++(std::isnan(x) ? s.nanCount : s.infiniteCount);
        continue;
      }
      s.isIntegral = s.isIntegral && x == std::trunc(x);
    }
    minimum = std::min(minimum, x);
    maximum = std::max(maximum, x);
  }
  if (s.nanCount + s.infiniteCount < samples.size()) {
    s.minimum = static_cast<double>(minimum);
    s.maximum = static_cast<double>(maximum);
  }
  return s;
}

/// Store of samples; `Stored` lists its types in order of preference. An integer type holds the
/// integers in its range. A floating-point type holds any number, rounded and clamped.
template <typename... Stored>
class SampleStore {
public:
  using Vectors = std::variant<LargeArray<Stored>...>;

  /// Reserves memory for `count` samples; pages are touched only as samples arrive.
  explicit SampleStore(std::size_t count) : m_count(count) { setType(0); }

  /// Appends a block with statistics `s`. Drops all samples once no type can hold them.
  template <typename T>
  void append(std::span<const T> block, const SampleStats& s) {
    m_stats.add(s);
    if (const std::size_t needed = findSmallestType(); needed != m_index)
      setType(needed);
    if (m_index < sizeof...(Stored))
      std::visit([&](auto& to) { copy(block, to); }, m_samples);
  }

  const SampleStats& stats() const { return m_stats; }
  bool canHoldAll() const { return m_index < sizeof...(Stored); }

  /// Minimum and maximum of the samples that take() returns.
  std::array<double, 2> range() const {
    return std::visit(
        [this]<typename To>(const LargeArray<To>&) -> std::array<double, 2> {
          return {static_cast<double>(convertSample<To>(m_stats.minimum)),
                  static_cast<double>(convertSample<To>(m_stats.maximum))};
        },
        m_samples);
  }

  /// Moves all samples out; requires canHoldAll(). NaN and -infinity become the minimum of the
  /// finite samples, +infinity the maximum.
  Vectors take() {
    if (!m_stats.isFinite()) {
      std::visit([this](auto& samples) { this->replaceNonFinite(samples); }, m_samples);
      m_stats.nanCount = m_stats.infiniteCount = 0;
      if (const std::size_t needed = findSmallestType(); needed != m_index)
        setType(needed);
    }
    return std::move(m_samples);
  }

private:
  template <typename To>
  bool canHold() const {
    if constexpr (std::is_floating_point_v<To>)
      return true;
    else
      return m_stats.isFinite() && m_stats.isIntegral &&
             m_stats.minimum >= static_cast<double>(std::numeric_limits<To>::min()) &&
             m_stats.maximum <= static_cast<double>(std::numeric_limits<To>::max());
  }

  std::size_t findSmallestType() const {
    const std::array<bool, sizeof...(Stored)> fitting = {canHold<Stored>()...};
    return static_cast<std::size_t>(std::find(fitting.begin(), fitting.end(), true) -
                                    fitting.begin());
  }

  /// Converts the samples to the type with index `wanted`; drops them if there is no such type.
  void setType(std::size_t wanted) {
    const Vectors previous = std::exchange(m_samples, Vectors());
    m_index = wanted;
    std::size_t index = 0;
    ((index++ == wanted ? convertAll<LargeArray<Stored>>(previous) : void()), ...);
  }
  template <typename Samples>
  void convertAll(const Vectors& previous) {
    auto& samples = m_samples.template emplace<Samples>();
    samples.reserve(m_count);
    std::visit([&](const auto& from) { copy(std::span(from), samples); }, previous);
  }

  /// Appends chunk by chunk: resize() zeroes the new elements first, which is cheap while a chunk
  /// stays in cache.
  template <typename T, typename To>
  static void copy(std::span<const T> from, LargeArray<To>& to) {
    if constexpr (std::is_same_v<T, To>)
      to.insert(to.end(), from.begin(), from.end());
    else
      while (!from.empty()) {
        const auto part = from.first(std::min<std::size_t>(from.size(), 1 << 16));
        const auto end = static_cast<std::ptrdiff_t>(to.size());
        to.resize(to.size() + part.size());
        std::transform(part.begin(), part.end(), to.begin() + end, convertSample<To, T>);
        from = from.subspan(part.size());
      }
  }

  template <typename To, typename T>
  static To convertSample(T x) {
    if constexpr (std::is_same_v<T, double> && std::is_same_v<To, float>) {
      constexpr double limit = std::numeric_limits<float>::max();
      return std::isinf(x) ? static_cast<float>(x)
                           : static_cast<float>(std::clamp(x, -limit, limit)); // NaN passes through
    }
    if constexpr (std::is_floating_point_v<To>)
      return static_cast<To>(static_cast<double>(x)); // rounds as range() does
    return static_cast<To>(x);
  }

  template <typename To>
  void replaceNonFinite(LargeArray<To>& samples) const {
    if constexpr (std::is_floating_point_v<To>) {
      const auto minimum = convertSample<To>(m_stats.minimum);
      const auto maximum = convertSample<To>(m_stats.maximum);
      for (To& x : samples)
        if (!std::isfinite(x))
          x = x > 0 ? maximum : minimum;
    }
  }

  std::size_t m_count;
  std::size_t m_index = 0; ///< index of the type; sizeof...(Stored): none
  Vectors m_samples;
  SampleStats m_stats;
};

} // namespace fenestra::core
