#include "integrator/simd/PiecewiseLinear.h"

#include "base/Narrow.h"

namespace fenestra::core {
namespace {

constexpr std::size_t lineCount = 1024; ///< bins per function, each with one line

/// Appends the lines of a function over the equal bins of `bins`.
void appendLines(std::vector<SimdTable::Line>& lines, const ScalarFunction& function,
                 const Interval& bins) {
  const auto& knots = function.knots();
  const double width = (bins.end - bins.begin) / static_cast<double>(lineCount);
  // Bound of float rounding errors.
  const double rounding =
      2.5e-4 * width + 0x1p-22 * std::max(std::abs(bins.begin), std::abs(bins.end));
  const bool isFine = rounding < 0.1 * width || knots.size() == 1;
  const auto lower = [&](double position) {
    return std::ranges::lower_bound(knots, position, {}, &ScalarFunction::Knot::position);
  };
  const auto upper = [&](double position) {
    return std::ranges::upper_bound(knots, position, {}, &ScalarFunction::Knot::position);
  };
  for (std::size_t bin = 0; bin < lineCount; ++bin) {
    const double low = bins.begin + width * static_cast<double>(bin), high = low + width;
    // A bin may have one knot on each edge, where the function bends but does not jump.
    const auto inside = upper(low + rounding);
    const bool isLine = isFine && inside - lower(low - rounding) <= 1 &&
                        lower(high - rounding) <= inside && upper(high + rounding) - inside <= 1;
    const double value = function(low + 0.25 * width)[0], later = function(low + 0.75 * width)[0];
    const double rise = 2.0 * (later - value);
    lines.push_back({narrow(value - 0.25 * rise),
                     isLine ? narrow(rise) : std::numeric_limits<float>::quiet_NaN()});
  }
  lines.push_back({narrow(knots.back().value[0]), 0.0F}); // from the last knot on
}

/// Bins per scalar unit over a range; 0 if a float cannot represent it.
float computeBinsPerUnit(std::size_t count, double range) {
  const float perUnit = range > 0.0 ? narrow(static_cast<double>(count) / range) : 0.0F;
  return std::isfinite(perUnit) ? perUnit : 0.0F;
}

} // namespace

template <int Channels>
SimdTable::SimdTable(const PiecewiseLinear<Channels>& function) {
  const auto& knots = function.knots();
  position = {-std::numeric_limits<float>::infinity()};
  for (const auto& knot : knots)
    position.push_back(narrow(knot.position));
  position.push_back(std::numeric_limits<float>::infinity());
  for (int c = 0; c < Channels; ++c) {
    Channel channel{{narrow(knots.front().value[c]), 0.0F}};
    for (std::size_t i = 0; i < knots.size(); ++i) {
      const auto& next = knots[std::min(i + 1, knots.size() - 1)];
      const double width = next.position - knots[i].position;
      const double rise = next.value[c] - knots[i].value[c];
      channel.push_back({narrow(knots[i].value[c]), width > 0.0 ? narrow(rise / width) : 0.0F});
    }
    channels.push_back(std::move(channel));
  }

  // More bins than segments, so that a look-up tries few segments.
  const std::size_t bins = 2 * knots.size();
  binStart = narrow(knots.front().position);
  const double span = function.span();
  binsPerUnit = computeBinsPerUnit(bins, span);
  for (std::size_t bin = 0; bin < bins; ++bin) {
    // One bin early, so that rounding cannot skip a segment.
    const double start = knots.front().position +
                         span * (static_cast<double>(bin) - 1.0) / static_cast<double>(bins);
    const auto segment = std::ranges::upper_bound(position, start) - position.begin() - 1;
    binSegment.push_back(binsPerUnit > 0.0F ? static_cast<std::int32_t>(segment) : 0);
  }
}

template SimdTable::SimdTable(const PiecewiseLinear<1>&);
template SimdTable::SimdTable(const PiecewiseLinear<3>&);

SimdLines::SimdLines(const std::vector<const ScalarFunction*>& functions) {
  Interval bins{infinity, -infinity};
  for (const ScalarFunction* function : functions)
    bins = enclose(bins, {function->knots().front().position, function->knots().back().position});
  start = narrow(bins.begin);
  binsPerUnit = computeBinsPerUnit(lineCount, bins.end - bins.begin);
  for (const ScalarFunction* function : functions) {
    segments.emplace_back(*function);
    if (bins.isEmpty() || binsPerUnit > 0.0F)
      appendLines(lines, *function, bins);
    else
      lines.push_back({0.0F, std::numeric_limits<float>::quiet_NaN()});
  }
  count = static_cast<std::int32_t>(lines.size() / functions.size());
  last = static_cast<float>(count - 1);
}

} // namespace fenestra::core
