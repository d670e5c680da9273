#include "files/medical/HounsfieldOffset.h"

#include "base/Distribution.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

namespace fenestra::core {
namespace {

constexpr int hounsfieldOffset = 1024; ///< the stored value of 0 HU

/// Most frequent value, in bins of 25, of the voxels on the four sides parallel to the slice axis.
template <typename Voxel>
double computeSideMode(const LargeArray<Voxel>& voxels, const Size3& size) {
  constexpr double width = 25.0;
  std::map<long, std::size_t> counts;
  for (std::int64_t z = 0; z < size.z(); ++z)
    for (std::int64_t y = 0; y < size.y(); ++y) {
      const bool isEdge = y == 0 || y + 1 == size.y();
      const std::int64_t step = isEdge ? 1 : std::max<std::int64_t>(1, size.x() - 1);
      for (std::int64_t x = 0; x < size.x(); x += step) {
        const auto i = static_cast<std::size_t>(x + size.x() * (y + size.y() * z));
        ++counts[std::lround(static_cast<double>(voxels[i]) / width)];
      }
    }
  const auto mode =
      std::ranges::max_element(counts, {}, [](const auto& one) { return one.second; });
  return width * static_cast<double>(mode->first);
}

/// Median of the voxels above 200; 0 if there are none.
template <typename Voxel>
double computeTissueMedian(const LargeArray<Voxel>& voxels) {
  std::vector<Voxel> tissue;
  std::ranges::copy_if(voxels, std::back_inserter(tissue), [](Voxel v) { return v > 200; });
  if (tissue.empty())
    return 0.0;
  return static_cast<double>(findMedian(tissue));
}

/// Subtracts the offset, in a type that holds the result.
template <typename Voxel>
Voxels subtractOffset(const LargeArray<Voxel>& voxels, double maximum) {
  const auto convert = [&]<typename To>(To) -> Voxels {
    LargeArray<To> to(voxels.size());
    std::ranges::transform(voxels, to.begin(),
                           [](Voxel v) { return static_cast<To>(v - hounsfieldOffset); });
    return to;
  };
  return std::integral<Voxel> && maximum - hounsfieldOffset <= 32767.0 ? convert(std::int16_t())
                                                                       : convert(float());
}

/// Returns the voxels in Hounsfield units if they are certainly offset; else nullopt. Warns.
template <typename Voxel>
std::optional<Voxels> toHounsfield(const LargeArray<Voxel>& voxels, Volume& volume) {
  constexpr double maxAirOffset = 50.0, minTissue = 800.0, maxTissue = 1300.0;
  if (std::abs(computeSideMode(voxels, volume.grid.size)) > maxAirOffset)
    return std::nullopt;
  const double tissue = computeTissueMedian(voxels);
  const bool isHounsfieldShifted = tissue >= minTissue && tissue <= maxTissue;
  volume.warnings.push_back(
      isHounsfieldShifted
          ? makeMessage(ErrorCode::removedHounsfieldOffset, volume.name,
                        "air is stored at 0, so 1024 is subtracted to get Hounsfield units")
          : makeMessage(ErrorCode::possibleHounsfieldOffset, volume.name,
                        "air is at 0, so values may not be Hounsfield units"));
  return isHounsfieldShifted ? std::optional(subtractOffset(voxels, volume.maximum)) : std::nullopt;
}

} // namespace

void correctHounsfieldOffset(Volume& volume) {
  constexpr double minValue = -200.0, minMaximum = 500.0; // below 500 there is no soft tissue
  if (volume.minimum < minValue || volume.maximum < minMaximum)
    return;
  auto hounsfield =
      std::visit([&](const auto& voxels) { return toHounsfield(voxels, volume); }, volume.voxels);
  if (!hounsfield)
    return;
  volume.voxels = std::move(*hounsfield);
  volume.minimum -= hounsfieldOffset;
  volume.maximum -= hounsfieldOffset;
}

} // namespace fenestra::core
