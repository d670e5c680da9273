#pragma once
// Keeps samples in the smallest type that holds all of them so far: a file's own, wider type never
// takes memory as a whole.

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

namespace fenestra {

/// Range and kind of samples. Doubles suffice: they hold every integer of 32 bits exactly.
struct SampleSurvey {
  double least = infinity, greatest = -infinity; ///< range of the finite samples
  bool whole = true;                             ///< all finite samples are whole numbers
  std::size_t notANumber = 0, infinite = 0;

  bool finite() const { return notANumber + infinite == 0; }

  void add(const SampleSurvey& more) {
    least = std::min(least, more.least);
    greatest = std::max(greatest, more.greatest);
    whole = whole && more.whole;
    notANumber += more.notANumber;
    infinite += more.infinite;
  }
};

template <typename T>
SampleSurvey survey(std::span<const T> samples) {
  SampleSurvey s;
  T least = std::numeric_limits<T>::max();
  T greatest = std::numeric_limits<T>::lowest();
  for (const T x : samples) {
    if constexpr (std::is_floating_point_v<T>) {
      if (!std::isfinite(x)) {
        ++(std::isnan(x) ? s.notANumber : s.infinite);
        continue;
      }
      s.whole = s.whole && x == std::trunc(x);
    }
    least = std::min(least, x);
    greatest = std::max(greatest, x);
  }
  if (s.notANumber + s.infinite < samples.size()) {
    s.least = static_cast<double>(least);
    s.greatest = static_cast<double>(greatest);
  }
  return s;
}

/// `Stored`: types in order of preference. Integers hold whole numbers in their range; a float
/// holds any number, rounded and clamped to its range.
template <typename... Stored>
class SampleStore {
public:
  using Vectors = std::variant<LargeArray<Stored>...>;

  /// Reserves room for `count` samples; pages are touched only as samples come.
  explicit SampleStore(std::size_t count) : m_count(count) { change(0); }

  /// Appends a block, whose survey is `s`. Drops all samples once no type holds them.
  template <typename T>
  void append(std::span<const T> block, const SampleSurvey& s) {
    m_survey.add(s);
    if (const std::size_t needed = smallest(); needed != m_index)
      change(needed);
    if (m_index < sizeof...(Stored))
      std::visit([&](auto& to) { copy(block, to); }, m_samples);
  }

  const SampleSurvey& survey() const { return m_survey; }
  bool holdsAll() const { return m_index < sizeof...(Stored); }

  /// Least and greatest sample that take() returns.
  std::array<double, 2> range() const {
    return std::visit(
        [this]<typename To>(const LargeArray<To>&) -> std::array<double, 2> {
          return {static_cast<double>(converted<To>(m_survey.least)),
                  static_cast<double>(converted<To>(m_survey.greatest))};
        },
        m_samples);
  }

  /// Moves all samples out; requires holdsAll(). NaN and -infinity become the least finite sample,
  /// +infinity the greatest.
  Vectors take() {
    if (!m_survey.finite()) {
      std::visit([this](auto& samples) { this->replaceNonFinite(samples); }, m_samples);
      m_survey.notANumber = m_survey.infinite = 0;
      if (const std::size_t needed = smallest(); needed != m_index)
        change(needed);
    }
    return std::move(m_samples);
  }

private:
  template <typename To>
  bool fits() const {
    if constexpr (std::is_floating_point_v<To>)
      return true;
    else
      return m_survey.finite() && m_survey.whole &&
             m_survey.least >= static_cast<double>(std::numeric_limits<To>::min()) &&
             m_survey.greatest <= static_cast<double>(std::numeric_limits<To>::max());
  }

  std::size_t smallest() const {
    const std::array<bool, sizeof...(Stored)> fitting = {fits<Stored>()...};
    return static_cast<std::size_t>(std::find(fitting.begin(), fitting.end(), true) -
                                    fitting.begin());
  }

  /// Converts the samples to the type of index `wanted`; drops them if there is no such type.
  void change(std::size_t wanted) {
    const Vectors before = std::exchange(m_samples, Vectors());
    m_index = wanted;
    std::size_t index = 0;
    ((index++ == wanted ? convert<LargeArray<Stored>>(before) : void()), ...);
  }
  template <typename Samples>
  void convert(const Vectors& before) {
    auto& samples = m_samples.template emplace<Samples>();
    samples.reserve(m_count);
    std::visit([&](const auto& from) { copy(std::span(from), samples); }, before);
  }

  /// Appends in parts: growing fills with zeros, which costs little while a part stays in the
  /// cache.
  template <typename T, typename To>
  static void copy(std::span<const T> from, LargeArray<To>& to) {
    if constexpr (std::is_same_v<T, To>)
      to.insert(to.end(), from.begin(), from.end());
    else
      while (!from.empty()) {
        const auto part = from.first(std::min<std::size_t>(from.size(), 1 << 16));
        const auto end = static_cast<std::ptrdiff_t>(to.size());
        to.resize(to.size() + part.size());
        std::transform(part.begin(), part.end(), to.begin() + end, converted<To, T>);
        from = from.subspan(part.size());
      }
  }

  template <typename To, typename T>
  static To converted(T x) {
    if constexpr (std::is_same_v<T, double> && std::is_same_v<To, float>) {
      constexpr double most = std::numeric_limits<float>::max();
      return std::isinf(x) ? static_cast<float>(x)
                           : static_cast<float>(std::clamp(x, -most, most)); // NaN stays
    }
    if constexpr (std::is_floating_point_v<To>)
      return static_cast<To>(static_cast<double>(x)); // range() then rounds as samples do
    return static_cast<To>(x);
  }

  template <typename To>
  void replaceNonFinite(LargeArray<To>& samples) const {
    if constexpr (std::is_floating_point_v<To>) {
      const auto least = converted<To>(m_survey.least);
      const auto greatest = converted<To>(m_survey.greatest);
      for (To& x : samples)
        if (!std::isfinite(x))
          x = x > 0 ? greatest : least;
    }
  }

  std::size_t m_count;
  std::size_t m_index = 0; ///< index of the type; sizeof...(Stored): none
  Vectors m_samples;
  SampleSurvey m_survey;
};

} // namespace fenestra
