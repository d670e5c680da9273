#include "files/medical/DicomPhases.h"

#include "base/Distribution.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace fenestra::core {
namespace {

/// Positions along the normal of the first slice, sorted.
std::vector<double> sortDepths(const DicomSlices& slices) {
  const Vec3 normal = findAxes(slices.front().header.orientation)->normal();
  std::vector<double> depths;
  for (const DicomSlice& slice : slices)
    depths.push_back(getPosition(slice).dot(normal));
  std::ranges::sort(depths);
  return depths;
}

struct Spacing {
  double step = 0.0; ///< median distance of neighbors
  bool isEven = true;
};

Spacing measureSpacing(const std::vector<double>& depths) {
  constexpr double evenness = 0.1; // of the step
  if (depths.size() < 2)
    return {};
  std::vector<double> gaps;
  for (std::size_t i = 1; i < depths.size(); ++i)
    gaps.push_back(depths[i] - depths[i - 1]);
  const double step = findMedian(gaps);
  return {step, std::ranges::all_of(
                    gaps, [=](double gap) { return std::abs(gap - step) <= evenness * step; })};
}

/// Ranges of positions of the groups in one phase.
class Ranges {
public:
  /// Adds the range of a group unless it overlaps with one that is there.
  bool add(const std::vector<double>& depths) {
    const Range range{depths.back(), measureSpacing(depths).step};
    const double lower = depths.front();
    const auto next = m_ranges.upper_bound(lower);
    if (next != m_ranges.end() && overlap(lower, range, next->first, next->second))
      return false;
    if (next != m_ranges.begin())
      if (const auto& [otherLower, other] = *std::prev(next);
          overlap(lower, range, otherLower, other))
        return false;
    m_ranges.emplace(lower, range);
    return true;
  }

private:
  struct Range {
    double upper, step;
  };
  static bool overlap(double lower, const Range& a, double otherLower, const Range& b) {
    const double most = 0.99 * std::max(a.step, b.step); // positions are rounded
    return std::min(a.upper, b.upper) - std::max(lower, otherLower) > most;
  }

  std::map<double, Range> m_ranges; ///< by the lower end
};

/// Distance of slices that the file states, mm; 0: none.
double getStatedStep(const DicomHeader& h) {
  const std::vector<double>& step = h.sliceSpacing.empty() ? h.sliceThickness : h.sliceSpacing;
  return step.size() == 1 && step[0] > 0.0 ? step[0] : 0.0;
}

} // namespace

std::vector<DicomSlices> joinPhases(const std::vector<DicomSlices>& groups) {
  std::vector<DicomSlices> phases;
  Ranges ranges;
  for (const DicomSlices& group : groups) {
    const std::vector<double> depths = sortDepths(group);
    if (phases.empty() || !ranges.add(depths)) {
      phases.emplace_back();
      ranges = {};
      ranges.add(depths);
    }
    phases.back().insert(phases.back().end(), group.begin(), group.end());
  }
  return phases;
}

bool canBeOneVolume(const std::vector<DicomSlices>& phases) {
  constexpr double densest = 0.75, sparsest = 1.5; // in stated steps
  DicomSlices together;
  for (const DicomSlices& phase : phases)
    together.insert(together.end(), phase.begin(), phase.end());
  const Spacing all = measureSpacing(sortDepths(together));
  const double stated = getStatedStep(together.front().header);
  if (all.isEven && all.step >= densest * stated)
    return true;
  return std::ranges::any_of(phases, [&](const DicomSlices& phase) {
    const Spacing own = measureSpacing(sortDepths(phase));
    return stated > 0.0 ? own.step > sparsest * stated : !own.isEven;
  });
}

} // namespace fenestra::core
