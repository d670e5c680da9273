#include "clip/focus/Contour.h"

#include <algorithm>
#include <array>

namespace fenestra::core {

namespace {

/// Step to the neighbor on each side, in the order of Crossing::side: quarter turns.
constexpr std::array<SampleStep, 4> steps{{{1, 0}, {0, 1}, {-1, 0}, {0, -1}}};

constexpr std::uint8_t rotateSide(int side, int quarters) {
  return static_cast<std::uint8_t>((side + quarters) & 3);
}

/// Next crossing on the contour. Of the four samples of the square ahead, two are the focus sample
/// and its neighbor outside; the other two decide how the contour turns.
Crossing findNextCrossing(const FocusDepth& focus, const Crossing& crossing) {
  const SampleStep out = outwardStep(crossing);
  const SampleStep ahead = steps[rotateSide(crossing.side, 1)];
  const std::int32_t column = crossing.column + ahead.column;
  const std::int32_t row = crossing.row + ahead.row;
  if (focus.isFocus(column + out.column, row + out.row)) // joins diagonal neighbors
    return {column + out.column, row + out.row, rotateSide(crossing.side, 3)};
  if (focus.isFocus(column, row))
    return {column, row, crossing.side};
  return {crossing.column, crossing.row, rotateSide(crossing.side, 1)};
}

std::int64_t sampleIndex(const DepthBuffer& buffer, const Crossing& crossing) {
  return buffer.sample(crossing.column, crossing.row);
}

/// Converts the focus samples of crossings to control points, without duplicates, in buffer order.
std::vector<ControlPoint> collectDistinctSamples(const DepthBuffer& buffer, Contour crossings) {
  const auto sample = [&](const Crossing& crossing) { return sampleIndex(buffer, crossing); };
  std::ranges::sort(crossings, {}, sample);
  const auto isSame = [&](const Crossing& a, const Crossing& b) { return sample(a) == sample(b); };
  crossings.erase(std::unique(crossings.begin(), crossings.end(), isSame), crossings.end());
  std::vector<ControlPoint> points;
  points.reserve(crossings.size());
  for (const Crossing& crossing : crossings)
    points.push_back({buffer.position(crossing.column, crossing.row), buffer.at(sample(crossing))});
  return points;
}

/// Calls visit(from, to, length) for each pair of successive crossings; length in mm.
template <typename Visitor>
void visitSegments(const DepthBuffer& buffer, const std::vector<Contour>& contours,
                   const Visitor& visit) {
  for (const Contour& contour : contours)
    for (std::size_t i = 0; i < contour.size(); ++i) {
      const Crossing& next = contour[i + 1 < contour.size() ? i + 1 : 0];
      visit(contour[i], next,
            (computeMidpoint(buffer, next) - computeMidpoint(buffer, contour[i])).norm());
    }
}

} // namespace

SampleStep outwardStep(const Crossing& crossing) {
  return steps[crossing.side];
}

std::vector<Contour> traceContours(const FocusDepth& focus) {
  const DepthBuffer& buffer = focus.depth;
  std::vector<std::uint8_t> visited(static_cast<std::size_t>(buffer.size())); // one bit per side
  const auto visit = [&](const Crossing& crossing) { // false if visited before
    std::uint8_t& sides = visited[static_cast<std::size_t>(sampleIndex(buffer, crossing))];
    const bool isNew = !(sides >> crossing.side & 1U);
    sides = static_cast<std::uint8_t>(sides | 1U << crossing.side);
    return isNew;
  };

  std::vector<Contour> contours;
  for (std::int32_t row = 0; row < buffer.rows(); ++row)
    for (std::int32_t column = 0; column < buffer.columns(); ++column) {
      if (!focus.isFocus(column, row))
        continue;
      for (std::uint8_t side = 0; side < 4; ++side) {
        if (focus.isFocus(column + steps[side].column, row + steps[side].row))
          continue;
        Contour contour;
        for (Crossing at{column, row, side}; visit(at); at = findNextCrossing(focus, at))
          contour.push_back(at);
        if (!contour.empty())
          contours.push_back(std::move(contour));
      }
    }
  return contours;
}

Vec2 computeMidpoint(const DepthBuffer& buffer, const Crossing& crossing) {
  const SampleStep out = outwardStep(crossing);
  return 0.5 * (buffer.position(crossing.column, crossing.row) +
                buffer.position(crossing.column + out.column, crossing.row + out.row));
}

std::vector<ControlPoint> placeControlPoints(const FocusDepth& focus,
                                             const std::vector<Contour>& contours, int count) {
  double total = 0.0;
  visitSegments(focus.depth, contours,
                [&](const Crossing&, const Crossing&, double length) { total += length; });
  const double spacing = total / count;

  Contour chosen;
  double arcLength = 0.0;
  visitSegments(focus.depth, contours,
                [&](const Crossing& from, const Crossing& to, double length) {
                  const auto next = [&] {
                    return (static_cast<double>(chosen.size()) + 0.5) * spacing - arcLength;
                  };
                  while (static_cast<int>(chosen.size()) < count && next() < length)
                    chosen.push_back(next() < 0.5 * length ? from : to);
                  arcLength += length;
                });
  return collectDistinctSamples(focus.depth, std::move(chosen));
}

std::vector<ControlPoint> findBoundarySamples(const FocusDepth& focus,
                                              const std::vector<Contour>& contours) {
  Contour all;
  for (const Contour& contour : contours)
    all.insert(all.end(), contour.begin(), contour.end());
  return collectDistinctSamples(focus.depth, std::move(all));
}

} // namespace fenestra::core
