// Smoothing of label maps without a choice by the user (smoothMaskAuto).

#include "base/LargePages.h"
#include "model/masks/EqualVolume.h"
#include "model/masks/GaussianBlur.h"
#include "model/masks/MaskShaping.h"
#include "model/masks/Rows.h"
#include "model/masks/ThinParts.h"

#include <algorithm>
#include <array>
#include <utility>

namespace fenestra::core {
namespace {

/// Radius, in native edges, of the ball that does not fit into thin parts; and their part of sigma.
constexpr double thinRadius = 2.0, thinSigma = 0.4;

/// Blurs a set of voxels, 0 or 1 each.
LargeArray<std::uint8_t> blurVoxels(std::vector<std::uint8_t> voxels, const Grid& grid,
                                    const Vec3& sigmas) {
  Mask mask;
  mask.grid = grid;
  mask.voxels = std::move(voxels);
  LargeArray<std::uint8_t> result(mask.voxels.size());
  blurMask(mask, Size3::Zero(), grid.size, sigmas, result.data());
  return result;
}

/// Smooths `places`, thin parts and narrow gaps, less.
void sharpen(const Mask& labels, const Size3& first, std::vector<std::uint8_t> places,
             Mask& smooth) {
  const Size3& size = smooth.grid.size;
  const Vec3 sigmas = thinSigma * smooth.smoothing * smooth.grid.spacing().cwiseInverse();
  const LargeArray<std::uint8_t> weights = blurVoxels(std::move(places), smooth.grid, sigmas);
  LargeArray<std::uint8_t> sharp(smooth.voxels.size());
  blurMask(labels, first, size, sigmas, sharp.data());
  forEachRow(size, [&](std::int64_t, std::int64_t, std::size_t row) {
    const auto end = row + static_cast<std::size_t>(size.x());
    if (std::all_of(weights.begin() + static_cast<std::ptrdiff_t>(row),
                    weights.begin() + static_cast<std::ptrdiff_t>(end),
                    [](std::uint8_t weight) { return weight == 0; }))
      return;
    for (std::size_t i = row; i < end; ++i) {
      const int more = weights[i] * (sharp[i] - smooth.voxels[i]);
      smooth.voxels[i] =
          static_cast<std::uint8_t>(smooth.voxels[i] + (more + (more < 0 ? -127 : 127)) / 255);
    }
  });
}

/// True if the mask is empty at a voxel and its six neighbors.
bool isEmptyAround(const Mask& mask, std::size_t voxel) {
  const auto at = static_cast<std::int64_t>(voxel);
  const Size3& size = mask.grid.size;
  const Size3 center(at % size.x(), at / size.x() % size.y(), at / (size.x() * size.y()));
  const auto isEmpty = [&](const Size3& place) {
    return (place.array() < 0).any() || (place.array() >= size.array()).any() ||
           mask.voxels[linearIndex(place, size)] < mask.threshold();
  };
  return isEmpty(center) && std::ranges::all_of(std::array{0, 1, 2}, [&](int axis) {
           return isEmpty(center - Size3::Unit(axis)) && isEmpty(center + Size3::Unit(axis));
         });
}

/// Restores voxels of thin parts that smoothing erased together with their neighbors. Returns true
/// if there are any.
bool restoreErased(const std::vector<std::size_t>& thin, Mask& smooth) {
  std::vector<std::size_t> erased;
  std::ranges::copy_if(thin, std::back_inserter(erased),
                       [&](std::size_t voxel) { return isEmptyAround(smooth, voxel); });
  for (const std::size_t voxel : erased)
    smooth.voxels[voxel] = smooth.maxValue;
  return !erased.empty();
}

} // namespace

Mask smoothMaskAuto(const Mask& mask, double native, const Grid& volume) {
  const double sigma = 1.25 * native;
  constexpr double mostVoxels = 16.0; // limits time
  if (sigma > mostVoxels * mask.grid.spacing().minCoeff())
    return mask; // extremely anisotropic voxels
  Mask result = smoothMask(mask, sigma, volume);
  const Size3 first = findOffset(result, mask);
  ThinParts thin = findThinParts(mask, first, result.grid.size, thinRadius * native);
  if (!thin.places.empty())
    sharpen(mask, first, std::move(thin.places), result);
  equalizeVolume(mask, volume, result);
  if (restoreErased(thin.inside, result)) { // with more volume
    equalizeVolume(mask, volume, result);
    restoreErased(thin.inside, result);
  }
  result.count = result.countInside();
  return result;
}

} // namespace fenestra::core
