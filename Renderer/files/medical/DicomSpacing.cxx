#include "files/medical/DicomSpacing.h"

#include "base/Distribution.h"

#include <algorithm>
#include <cmath>

namespace fenestra::core {
namespace {

constexpr double copyTolerance = 0.02; ///< fraction of a step

std::string formatMm(double length) {
  return toString(length, 4) + " mm";
}

std::vector<double> computeDepths(const std::vector<PlacedSlice>& slices, const Vec3& normal) {
  std::vector<double> depths;
  for (const PlacedSlice& slice : slices)
    depths.push_back(slice.position.dot(normal));
  return depths;
}

/// Distances of neighbors. Throws Error (input) if one is 0.
std::vector<double> computeGaps(const std::vector<PlacedSlice>& slices,
                                const std::vector<double>& depths) {
  constexpr double minGap = 1e-3; // mm
  std::vector<double> gaps;
  for (std::size_t i = 1; i < depths.size(); ++i) {
    gaps.push_back(depths[i] - depths[i - 1]);
    if (gaps.back() < minGap)
      throw fieldError(slices[i - 1].file, "ImagePositionPatient", "equals that of ",
                       slices[i].file,
                       ", and nothing in the files says how they differ; give "
                       "a series with one slice per position");
  }
  return gaps;
}

/// Throws Error (input) for slices beside the line through the first and the last.
void checkSides(const std::vector<PlacedSlice>& slices, const std::vector<double>& depths,
                const std::array<Vec3, 2>& sides, const std::array<double, 2>& pixel) {
  const Vec3 first = slices.front().position;
  const Vec3 direction = (slices.back().position - first) / (depths.back() - depths.front());
  for (std::size_t i = 0; i < slices.size(); ++i) {
    const Vec3 offset = slices[i].position - first - (depths[i] - depths[0]) * direction;
    for (std::size_t side = 0; side < 2; ++side)
      if (std::abs(offset.dot(sides[side])) > 0.5 * pixel[side])
        throw fieldError(slices[i].file, "ImagePositionPatient", "is ", formatMm(offset.norm()),
                         " beside the line through the other slices; resample the series in "
                         "Slicer and use the volume file");
  }
}

/// True if gaps and positions are within half a step of even spacing. Sets the greatest distance
/// from it.
bool isNearlyEven(const std::vector<double>& depths, const std::vector<double>& gaps,
                  double& maxOffset) {
  const double median = findMedian(std::vector(gaps));
  if (std::ranges::any_of(gaps, [=](double gap) { return std::abs(gap - median) > 0.5 * median; }))
    return false;
  const double step = (depths.back() - depths.front()) / static_cast<double>(gaps.size());
  for (std::size_t i = 0; i < depths.size(); ++i)
    maxOffset =
        std::max(maxOffset, std::abs(depths[i] - depths[0] - static_cast<double>(i) * step));
  return maxOffset <= 0.5 * step;
}

/// Number of even steps that are at most as long as the smallest gap, within the tolerance.
std::size_t countSteps(const std::vector<PlacedSlice>& slices, const std::vector<double>& gaps,
                       double length) {
  constexpr double mostSlices = 4.0; // per slice of the series
  const double smallest = *std::ranges::min_element(gaps);
  const double steps =
      std::ceil(length / smallest - copyTolerance * static_cast<double>(gaps.size()));
  if (steps <= mostSlices * static_cast<double>(slices.size()))
    return static_cast<std::size_t>(std::max(1.0, steps));
  const auto widest = static_cast<std::size_t>(std::ranges::max_element(gaps) - gaps.begin());
  throw fieldError(slices[widest].file, "ImagePositionPatient", "is ", formatMm(gaps[widest]),
                   " from ", slices[widest + 1].file, ", but the smallest distance is ",
                   formatMm(smallest), "; give a series without such a gap");
}

/// Slices of the volume at even positions.
std::vector<SliceBlend> blendSlices(const std::vector<double>& depths, std::size_t steps) {
  const double step = (depths.back() - depths.front()) / static_cast<double>(steps);
  std::vector<SliceBlend> blends;
  std::size_t lower = 0;
  for (std::size_t k = 0; k <= steps; ++k) {
    const double depth = depths.front() + static_cast<double>(k) * step;
    while (lower + 2 < depths.size() && depths[lower + 1] <= depth)
      ++lower;
    const double below = depth - depths[lower], above = depths[lower + 1] - depth;
    if (below <= copyTolerance * step)
      blends.push_back({lower, lower, 0.0});
    else if (above <= copyTolerance * step)
      blends.push_back({lower + 1, lower + 1, 0.0});
    else
      blends.push_back({lower, lower + 1, below / (below + above)});
  }
  return blends;
}

/// Gaps that are interpolated, like "6 mm between 30 and 36 mm".
std::string describeGaps(const std::vector<double>& depths, const std::vector<double>& gaps,
                         double step) {
  constexpr std::size_t maxListed = 3;
  std::vector<std::string> texts;
  for (std::size_t i = 0; i < gaps.size(); ++i)
    if (gaps[i] > (1.0 + copyTolerance) * step)
      texts.push_back(concat(formatMm(gaps[i]), " between ", toString(depths[i]), " and ",
                             formatMm(depths[i + 1])));
  return join(texts, ", ", {}, maxListed);
}

} // namespace

SliceSpacing computeSpacing(const std::vector<PlacedSlice>& slices, const Vec3& normal,
                            const std::array<Vec3, 2>& sides, const std::array<double, 2>& pixel,
                            const std::string& name, std::vector<Message>& warnings) {
  if (slices.size() == 1)
    return {normal, {{}}};
  const std::vector<double> depths = computeDepths(slices, normal);
  const std::vector<double> gaps = computeGaps(slices, depths);
  checkSides(slices, depths, sides, pixel);
  const Vec3 extent = slices.back().position - slices.front().position;
  double maxOffset = 0.0;
  if (isNearlyEven(depths, gaps, maxOffset)) {
    SliceSpacing spacing{extent / static_cast<double>(gaps.size())};
    for (std::size_t i = 0; i < slices.size(); ++i)
      spacing.slices.push_back({i, i, 0.0});
    if (maxOffset > copyTolerance * spacing.step.norm())
      warnings.push_back(makeMessage(ErrorCode::assumedGeometry, name, "slices are up to ",
                                     formatMm(maxOffset), " off even spacing; ",
                                     formatMm(spacing.step.norm()), " steps are used"));
    return spacing;
  }
  const std::size_t steps = countSteps(slices, gaps, depths.back() - depths.front());
  SliceSpacing spacing{extent / static_cast<double>(steps), blendSlices(depths, steps)};
  const std::size_t missing = steps + 1 - slices.size();
  warnings.push_back(
      makeMessage(ErrorCode::interpolatedSlices, name, "slices are missing or unevenly spaced (",
                  describeGaps(depths, gaps, spacing.step.dot(normal)), " along their normal); ",
                  missing, missing == 1 ? " slice is" : " slices are",
                  " interpolated, in steps of ", formatMm(spacing.step.norm())));
  return spacing;
}

} // namespace fenestra::core
