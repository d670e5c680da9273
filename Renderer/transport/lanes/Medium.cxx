#include "transport/lanes/Medium.h"

#include "base/Narrow.h"

namespace fenestra {
namespace {

constexpr std::size_t lineCount = 1024;

} // namespace

WideTable::Bins::Bins(double low, double high)
    : start(low),
      end(high),
      perUnit(high > low ? narrow(static_cast<double>(lineCount) / (high - low)) : 0.0F) {
  if (!std::isfinite(perUnit))
    perUnit = 0.0F;
}

template <int Channels>
std::vector<WideTable::Line>
WideTable::Bins::linesOf(const PiecewiseLinear<Channels>& function) const {
  if (end > start && perUnit == 0.0F)
    return {{0.0F, std::numeric_limits<float>::quiet_NaN()}};
  const auto& knots = function.knots();
  const double width = (end - start) / static_cast<double>(lineCount);
  // Rounding of a float.
  const double rounding = 2.5e-4 * width + 0x1p-22 * std::max(std::abs(start), std::abs(end));
  const bool isFine = rounding < 0.1 * width || knots.size() == 1;
  std::vector<Line> lines;
  std::size_t next = 0; // knot
  for (std::size_t bin = 0; bin < lineCount; ++bin) {
    const double low = start + width * static_cast<double>(bin), high = low + width;
    while (next < knots.size() && knots[next].position < low - rounding)
      ++next;
    // At its edges a bin may have one knot, where the function bends and does not jump.
    std::size_t after = next;
    int atLow = 0, atHigh = 0;
    for (; after < knots.size() && knots[after].position <= low + rounding; ++after)
      ++atLow;
    const bool isBent = after < knots.size() && knots[after].position < high - rounding;
    for (; after < knots.size() && knots[after].position <= high + rounding; ++after)
      ++atHigh;
    const double value = function(low + 0.25 * width)[0], later = function(low + 0.75 * width)[0];
    const double rise = 2.0 * (later - value);
    const bool isLine = isFine && !isBent && atLow <= 1 && atHigh <= 1;
    lines.push_back({narrow(value - 0.25 * rise),
                     isLine ? narrow(rise) : std::numeric_limits<float>::quiet_NaN()});
  }
  lines.push_back({narrow(knots.back().value[0]), 0.0F});
  return lines;
}

template <int Channels>
WideTable::WideTable(const PiecewiseLinear<Channels>& function) {
  const auto& knots = function.knots();
  position = {-std::numeric_limits<float>::infinity()};
  for (const auto& knot : knots)
    position.push_back(narrow(knot.position));
  position.push_back(std::numeric_limits<float>::infinity());
  for (int c = 0; c < Channels; ++c) {
    Channel channel{{narrow(knots.front().value[c]), 0.0F}};
    for (std::size_t i = 0; i < knots.size(); ++i) {
      const bool last = i + 1 == knots.size();
      const double width = last ? 0.0 : knots[i + 1].position - knots[i].position;
      const double rise = last ? 0.0 : knots[i + 1].value[c] - knots[i].value[c];
      channel.push_back({narrow(knots[i].value[c]), width > 0.0 ? narrow(rise / width) : 0.0F});
    }
    channels.push_back(std::move(channel));
  }

  // More bins than segments, so that few segments have to be tried.
  const std::size_t bins = 2 * knots.size();
  binStart = narrow(knots.front().position);
  const double span = function.span();
  binsPerUnit = span > 0.0 ? narrow(static_cast<double>(bins) / span) : 0.0F;
  if (!std::isfinite(binsPerUnit))
    binsPerUnit = 0.0F;
  std::size_t segment = 0;
  for (std::size_t bin = 0; bin < bins; ++bin) {
    // One bin early: rounding must not lead past a segment.
    const double start = knots.front().position +
                         span * (static_cast<double>(bin) - 1.0) / static_cast<double>(bins);
    while (static_cast<double>(position[segment + 1]) <= start && segment + 2 < position.size())
      ++segment;
    binSegment.push_back(binsPerUnit > 0.0F ? static_cast<std::int32_t>(segment) : 0);
  }
  const Bins equal(knots.front().position, knots.back().position);
  lines = equal.linesOf(function);
  linesPerUnit = equal.perUnit;
  lastLine = static_cast<float>(lines.size() - 1);
}

template WideTable::WideTable(const PiecewiseLinear<1>&);
template WideTable::WideTable(const PiecewiseLinear<3>&);
template std::vector<WideTable::Line> WideTable::Bins::linesOf(const PiecewiseLinear<1>&) const;

} // namespace fenestra
