#include "scene/DefaultTransfer.h"

#include "base/Color.h"
#include "base/Distribution.h"
#include "model/medium/Reflectance.h"
#include "scene/Defaults.h"
#include "scene/NamedPresets.h"
#include "scene/OrganPresets.h"

#include <algorithm>
#include <numeric>

namespace fenestra::core {
namespace {

/// Segments of `patterns` that have voxels.
std::vector<SegmentInfo> findSegments(const SegmentPatterns& patterns,
                                      const Segmentation& segmentation,
                                      const std::vector<bool>& hasVoxels) {
  std::vector<SegmentInfo> present;
  for (std::size_t i = 0; i < hasVoxels.size(); ++i)
    if (hasVoxels[i])
      present.push_back(segmentation.segments()[i]);
  return findFocusSegments(patterns, present);
}

/// Values of air in MR are below it.
double findHighestAir(const std::array<double, 2>& robustRange) {
  const auto [low, high] = robustRange;
  return low + 0.06 * (high - low);
}

/// One step of Lloyd's algorithm: the mean of the sorted values that are nearest to each center.
/// A center without values stays.
std::array<double, 3> moveCenters(const std::vector<double>& sorted,
                                  const std::array<double, 3>& centers) {
  std::array<double, 3> moved = centers;
  auto from = sorted.begin();
  for (std::size_t i = 0; i < 3; ++i) {
    const auto to = i == 2
                        ? sorted.end()
                        : std::lower_bound(from, sorted.end(), 0.5 * (centers[i] + centers[i + 1]));
    if (to != from)
      moved[i] = std::accumulate(from, to, 0.0) / static_cast<double>(to - from);
    from = to;
  }
  return moved;
}

/// True if many values are as low as those of air around a body.
bool hasAir(const Volume& volume) {
  constexpr double leastFraction = 0.1;
  const std::vector<double> values = sampleValues(volume);
  const double highest = findHighestAir(findRobustRange(volume));
  const auto count = std::ranges::count_if(values, [=](double value) { return value < highest; });
  return static_cast<double>(count) >= leastFraction * static_cast<double>(values.size());
}

} // namespace

ScanContent describeScan(const Volume& volume, const Segmentation& segmentation,
                         const std::vector<bool>& hasVoxels,
                         const std::vector<std::string>& focus) {
  static const SegmentPatterns bloodPatterns = {.names = {"aorta*", "heart*"},
                                                .codes = {"SCT^15825003", "SCT^80891009"}};
  ScanContent content{.hasSegments = true};
  std::vector<SegmentInfo> chosen;
  for (const std::string& selector : focus)
    chosen.push_back(segmentation.segments()[segmentation.find(selector)]);
  content.isLungFocus =
      !focus.empty() &&
      findFocusSegments(findOrganPreset("lungs").focus, chosen).size() == chosen.size();
  if (isPlausibleModality(Modality::ct, volume)) {
    for (const SegmentInfo& segment : findSegments(bloodPatterns, segmentation, hasVoxels))
      if (auto values = sampleValues(volume, segmentation.makeMask({segment}, volume.grid));
          !values.empty())
        content.blood = std::max(content.blood.value_or(-infinity), findMedian(values));
    return content;
  }
  static const SegmentPatterns kneePatterns = {.names = {"patell*", "menisc*", "cruciate*"},
                                               .codes = {"SCT^64234005", "SCT^244564004"}};
  content.isKnee = !findSegments(kneePatterns, segmentation, hasVoxels).empty();
  const auto brain = findSegments(findOrganPreset("brain-surface").focus, segmentation, hasVoxels);
  if (!brain.empty())
    content.brain = sampleValues(volume, segmentation.makeMask(brain, volume.grid));
  return content;
}

std::optional<std::string> chooseTransferPreset(const Volume& volume, const ScanContent& content) {
  constexpr double leastBlood = 130.0; // HU, with contrast agent
  if (volume.minimum == volume.maximum)
    return std::nullopt; // no surfaces
  if (isPlausibleModality(Modality::ct, volume)) {
    if (!content.hasSegments)
      return "ct-skin";
    if (content.isLungFocus)
      return "ct-lung";
    const bool hasAgent = content.blood ? *content.blood > leastBlood : volume.hasContrastAgent;
    return hasAgent ? "ct-contrast" : "ct-anatomy";
  }
  if (volume.modality == Modality::us)
    return "us-fetal";
  constexpr double greatestUptake = 1000.0; // SUV; values in Bq/ml exceed it
  if (volume.modality == Modality::pt)
    return volume.maximum < greatestUptake ? std::optional("pet") : std::nullopt;
  const bool isMr = volume.modality == Modality::mr || !content.brain.empty() || hasAir(volume);
  if (isMr)
    return content.isKnee ? "mr-knee" : "mr-anatomy";
  return std::nullopt;
}

TransferFunction fitToVolume(const TransferFile& transfer, const Volume& volume,
                             const ScanContent& content) {
  switch (transfer.scalars) {
  case TransferFile::Scalars::absolute:
    break;
  case TransferFile::Scalars::relative:
    return transfer.mapScalars(findRobustRange(volume));
  case TransferFile::Scalars::tissues:
    return transfer.mapScalars(findTissues(volume, content.brain));
  }
  return transfer.function;
}

TissueScale findTissues(const Volume& volume, const std::vector<double>& brain) {
  const std::array<double, 2> range = findRobustRange(volume);
  const auto [low, high] = range;
  std::vector<double> values = brain.empty() ? sampleValues(volume) : brain;
  std::erase_if(values, [least = findHighestAir(range)](double value) { return value < least; });
  std::ranges::sort(values);
  for (double& value : values) // bright outliers, such as fat and vessels
    value = std::min(value, high);
  std::array<double, 3> centers = {};
  for (std::size_t i = 0; i < 3 && !values.empty(); ++i)
    centers[i] = values[values.size() * (2 * i + 1) / 6];
  for (int step = 0; step < 100; ++step) {
    const std::array<double, 3> moved = moveCenters(values, centers);
    if (moved == centers)
      break;
    centers = moved;
  }
  if (low < centers[0] && centers[0] < centers[1] && centers[1] < centers[2])
    return {low, centers[0], centers[1], centers[2]};
  const double step = (high > low ? high - low : 1.0) / 3.0;
  return {low, low + step, low + 2.0 * step, low + 3.0 * step};
}

TransferFunction makeRelativeTransfer(const Volume& volume) {
  const double unit =
      100.0 / volume.grid.boundingRadius(); // the extinctions below are for a radius of 100 mm
  const std::array<double, 2> range = findRobustRange(volume);
  const double low = range[0], high = range[1];
  if (!(high > low))
    return {ScalarFunction({{low, ScalarFunction::Value(0.02 * unit)}}),
            ColorFunction({{low, Rgb(0.9, 0.85, 0.8)}})};

  const double background = otsuThreshold(volume, low, high);
  const auto between = [&](double f) { return background + f * (high - background); };
  const auto at = [&](double f) { return low + f * (high - low); };
  const auto knot = [](double s, double sigma_t) {
    return ScalarFunction::Knot{s, ScalarFunction::Value(sigma_t)};
  };
  const double start = background - 0.35 * (background - low);
  return {ScalarFunction({knot(start, 0.0), knot(background, 0.8 * unit),
                          knot(between(0.3), 2.5 * unit), knot(high, 5.0 * unit)}),
          toAlbedo(ColorFunction({{at(0.05), decodeSrgb(Rgb(0.816, 0.643, 0.580))},
                                  {at(0.15), decodeSrgb(Rgb(0.769, 0.565, 0.502))},
                                  {at(0.35), decodeSrgb(Rgb(0.729, 0.525, 0.455))},
                                  {at(0.6), decodeSrgb(Rgb(0.808, 0.627, 0.541))},
                                  {at(1.0), decodeSrgb(Rgb(0.925, 0.831, 0.745))}}),
                   0.0),
          {},
          0.0,
          SurfaceShading::makeCoated(0.2, 0.45)};
}

} // namespace fenestra::core
