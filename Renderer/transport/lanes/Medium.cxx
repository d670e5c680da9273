#include "transport/lanes/Medium.h"

#include "base/Narrow.h"

namespace fenestra {

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
}

template WideTable::WideTable(const PiecewiseLinear<1>&);
template WideTable::WideTable(const PiecewiseLinear<3>&);

} // namespace fenestra
