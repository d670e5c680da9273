#include "clipping/Sewing.h"

#include <algorithm>

namespace fenestra {
namespace {

constexpr int side = DepthBuffer::fineSide;

/// A seam and the four samples around it. Positions are in cells, from the first sample.
class SeamCell {
public:
  SeamCell(const DepthBuffer& buffer, const FocusDepth& focus, const Seam& seam)
      : m_seam(seam),
        m_pitch(
            (buffer.position(seam.column + 1, seam.row) - buffer.position(seam.column, seam.row))
                .norm()) {
    for (int corner = 0; corner < 4; ++corner) {
      const std::int64_t column = seam.column + corner % 2, row = seam.row + corner / 2;
      const auto i = static_cast<std::size_t>(corner);
      m_isFocus[i] = focus.isFocus(column, row);
      m_depths[i] = buffer.at(buffer.sample(column, row));
    }
  }

  double depth(int column, int row) const {
    const auto [focus, isWhole] = focusIn(column, row);
    if (isWhole)
      return focus;
    const Vec2 center((column + 0.5) / side, (row + 0.5) / side);
    const auto [nearest, distance] = nearestFocus(center);
    if (focus > -infinity) // it ends in the square
      return std::max(focus, nearest);
    if (std::ranges::find(m_isFocus, false) == m_isFocus.end())
      return nearest; // a hole that no sample is in
    const double toContext = distanceToContext(center);
    const double reached = std::max(0.0, distance - 1.0 / side);
    const double share = reached / (reached + toContext);
    return nearest + share * (context(center) - nearest);
  }

private:
  double focusAt(int column, int row) const {
    return m_seam
        .depths[static_cast<std::size_t>(row) * Seam::across + static_cast<std::size_t>(column)];
  }

  struct InSquare {
    double greatest; ///< depth of the focus at a square's corners; -infinity where there is none
    bool isWhole;    ///< all corners are focus
  };
  InSquare focusIn(int column, int row) const {
    InSquare focus{-infinity, true};
    for (int j = row; j <= row + 1; ++j)
      for (int i = column; i <= column + 1; ++i)
        if (const double depth = focusAt(i, j); depth < infinity)
          focus.greatest = std::max(focus.greatest, depth);
        else
          focus.isWhole = false;
    return focus;
  }

  struct Nearest {
    double depth, distance;
  };
  /// The focus's depth at the nearest corner, which goes on falling away for a square as it does
  /// before it: the focus ends beyond the corner.
  Nearest nearestFocus(const Vec2& from) const {
    Nearest nearest{0.0, infinity};
    int at = 0;
    for (int corner = 0; corner < static_cast<int>(Seam::corners); ++corner)
      if (const double depth = m_seam.depths[static_cast<std::size_t>(corner)]; depth < infinity) {
        const double distance = (Seam::fraction(corner) - from).norm();
        if (distance < nearest.distance) {
          nearest = {depth, distance};
          at = corner;
        }
      }
    const Vec2 inward = Seam::fraction(at) - from;
    const auto step = [](double x) { return std::abs(x) * side < 0.25 ? 0 : x < 0.0 ? -1 : 1; };
    const int column = at % Seam::across + step(inward.x());
    const int row = at / Seam::across + step(inward.y());
    if (std::min(column, row) >= 0 && std::max(column, row) < Seam::across)
      if (const double inner = focusAt(column, row); inner < infinity)
        nearest.depth += std::clamp(nearest.depth - inner, 0.0, steepestEnd * m_pitch);
    return nearest;
  }

  /// To the nearest edge with no focus at its ends, or sample that is none.
  double distanceToContext(const Vec2& from) const {
    double distance = infinity;
    for (int corner = 0; corner < 4; ++corner)
      if (!m_isFocus[static_cast<std::size_t>(corner)])
        distance = std::min(distance, (from - Vec2(corner % 2, corner / 2)).norm());
    const auto none = [&](std::size_t a, std::size_t b) { return !m_isFocus[a] && !m_isFocus[b]; };
    if (none(0, 1))
      distance = std::min(distance, from.y());
    if (none(2, 3))
      distance = std::min(distance, 1.0 - from.y());
    if (none(0, 2))
      distance = std::min(distance, from.x());
    if (none(1, 3))
      distance = std::min(distance, 1.0 - from.x());
    return distance;
  }

  /// Between the samples that are not focus, linear as far as they go.
  double context(const Vec2& at) const {
    const std::array weights{(1.0 - at.x()) * (1.0 - at.y()), at.x() * (1.0 - at.y()),
                             (1.0 - at.x()) * at.y(), at.x() * at.y()};
    double sum = 0.0, weight = 0.0;
    for (std::size_t i = 0; i < 4; ++i)
      if (!m_isFocus[i]) {
        sum += weights[i] * m_depths[i];
        weight += weights[i];
      }
    return sum / weight;
  }

  /// Pitches of depth that the focus may fall away by in a square.
  static constexpr double steepestEnd = 4.0;

  const Seam& m_seam;
  double m_pitch; ///< mm between samples
  std::array<bool, 4> m_isFocus{};
  std::array<double, 4> m_depths{};
};

} // namespace

void sew(DepthBuffer& buffer, const FocusDepth& focus, const std::vector<Seam>& seams) {
  for (const Seam& seam : seams) {
    const SeamCell cell(buffer, focus, seam);
    DepthBuffer::FineCell depths;
    for (int row = 0; row < side; ++row)
      for (int column = 0; column < side; ++column)
        depths[static_cast<std::size_t>(row) * side + static_cast<std::size_t>(column)] =
            cell.depth(column, row);
    buffer.refine(buffer.sample(seam.column, seam.row), depths);
  }
}

} // namespace fenestra
