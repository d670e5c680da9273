#include "model/masks/MaskShaping.h"

#include "base/Error.h"
#include "model/masks/GaussianBlur.h"

#include <itkImage.h>
#include <itkSignedMaurerDistanceMapImageFilter.h>
#include <itkSmoothingRecursiveGaussianImageFilter.h>
#include <tbb/parallel_for.h>

#include <algorithm>

namespace fenestra {
namespace {

using ItkImage = itk::Image<float, 3>;

/// A box of voxels in a mask's index space.
struct Region {
  Size3 first, size;

  Size3 end() const { return first + size; }
};

/// The mask's region padded by `padding` mm, but at most one voxel beyond the volume.
Region padRegion(const Mask& mask, double padding, const Grid& volume) {
  const Affine toMask = mask.grid.worldToIndex * volume.indexToWorld;
  Vec3 lower = Vec3::Constant(infinity), upper = -lower;
  for (int i = 0; i < 8; ++i) {
    const Vec3 corner = toMask * volume.indexBox().corner(i);
    lower = lower.cwiseMin(corner);
    upper = upper.cwiseMax(corner);
  }
  const Vec3 voxels = (padding * mask.grid.spacing().cwiseInverse()).array().ceil() + 1.0;
  const Vec3 last = (mask.grid.size.array() - 1).cast<double>();
  const Vec3 first = (-voxels).cwiseMax((lower.array().floor() - 1.0).matrix()).cwiseMin(0.0);
  const Vec3 end = (last + voxels).cwiseMin((upper.array().ceil() + 1.0).matrix()).cwiseMax(last);
  constexpr double fewest = 4.0; // voxels; minimum for recursive filters and ContextStyle
  const Vec3 size = (end - first + Vec3::Ones()).cwiseMax(fewest);
  if (size.prod() > 0x1p31)
    throw outputError(ErrorCode::largeShapedFocus, "focus",
                      "with its margin and smoothing it has more than 2^31 voxels");
  return {first.cast<std::int64_t>(), size.cast<std::int64_t>()};
}

/// Calls visit(voxel, its linear index in `region`) for each voxel of the region.
template <typename Visitor>
void forEachVoxel(const Region& region, const Visitor& visit) {
  std::size_t number = 0;
  for (std::int64_t z = region.first.z(); z < region.end().z(); ++z)
    for (std::int64_t y = region.first.y(); y < region.end().y(); ++y)
      for (std::int64_t x = region.first.x(); x < region.end().x(); ++x)
        visit(Size3(x, y, z), number++);
}

/// ITK image of the indicator in a region, with spacing in mm. Outside the mask the nearest voxel
/// repeats.
ItkImage::Pointer toItkImage(const Mask& mask, const Region& region) {
  const auto image = ItkImage::New();
  ItkImage::SizeType size;
  ItkImage::SpacingType spacing;
  for (unsigned axis = 0; axis < 3; ++axis) {
    size[axis] = static_cast<ItkImage::SizeValueType>(region.size[axis]);
    spacing[axis] = mask.grid.spacing()[axis];
  }
  image->SetRegions(size);
  image->SetSpacing(spacing);
  image->Allocate();
  float* const to = image->GetBufferPointer();
  forEachVoxel(region, [&](const Size3& voxel, std::size_t number) {
    const Size3 inside = voxel.cwiseMax(0).cwiseMin((mask.grid.size.array() - 1).matrix());
    const std::uint8_t value = mask.voxels[linearIndex(inside, mask.grid.size)];
    to[number] = static_cast<float>(value) / static_cast<float>(mask.maxValue);
  });
  return image;
}

/// Mask of the same segments on a region of the grid.
Mask makeRegionMask(const Mask& from, const Region& region, std::uint8_t maxValue,
                    std::vector<std::uint8_t> voxels) {
  Affine indexToWorld = from.grid.indexToWorld;
  indexToWorld.translate(region.first.cast<double>());
  Mask mask{{region.size, indexToWorld}, std::move(voxels), 0, from.names, maxValue};
  mask.count = std::ranges::count_if(
      mask.voxels, [half = mask.threshold()](std::uint8_t voxel) { return voxel >= half; });
  return mask;
}

} // namespace

Mask applyMargin(Mask mask, double margin, const Grid& volume) {
  if (margin == 0.0)
    return mask;
  const Region region =
      margin > 0.0 ? padRegion(mask, margin, volume) : Region{Size3::Zero(), mask.grid.size};
  // Signed distances, mm, to the mask's boundary voxels (margin < 0: to its complement's), which
  // have distance 0; positive outside.
  const ItkImage::Pointer pixels = toItkImage(mask, region);
  if (margin < 0.0)
    std::transform(pixels->GetBufferPointer(),
                   pixels->GetBufferPointer() + pixels->GetBufferedRegion().GetNumberOfPixels(),
                   pixels->GetBufferPointer(), [](float inside) { return 1.0F - inside; });
  const auto distance = itk::SignedMaurerDistanceMapImageFilter<ItkImage, ItkImage>::New();
  distance->SetInput(pixels);
  distance->SetUseImageSpacing(true);
  distance->SetSquaredDistance(false);
  distance->Update();
  const float* const from = distance->GetOutput()->GetBufferPointer();
  const auto radius = static_cast<float>(std::abs(margin) * (1.0 + 1e-6)); // rounding
  std::vector<std::uint8_t> voxels(static_cast<std::size_t>(region.size.prod()));
  std::transform(from, from + voxels.size(), voxels.begin(), [&](float away) -> std::uint8_t {
    return margin > 0.0 ? away <= radius : away > radius;
  });
  return makeRegionMask(mask, region, 1, std::move(voxels));
}

Mask uniteMasks(std::vector<Mask> masks) {
  if (masks.size() == 1)
    return std::move(masks.front());
  const Mask& first = masks.front();
  // Region of a mask in the voxels of the first mask.
  const auto findRegion = [&](const Mask& mask) {
    const Vec3 place = first.grid.worldToIndex * mask.grid.indexToWorld.translation();
    return Region{place.array().round().cast<std::int64_t>(), mask.grid.size};
  };
  Region all = findRegion(first);
  for (const Mask& mask : masks) {
    const Region region = findRegion(mask);
    const Size3 lower = all.first.cwiseMin(region.first), end = all.end().cwiseMax(region.end());
    all = {lower, end - lower};
  }
  Mask result = makeRegionMask(
      first, all, 1, std::vector<std::uint8_t>(static_cast<std::size_t>(all.size.prod())));
  for (const Mask& mask : masks) {
    const Region region = findRegion(mask);
    forEachVoxel(region, [&](const Size3& voxel, std::size_t number) {
      std::uint8_t& to = result.voxels[linearIndex(voxel - all.first, all.size)];
      result.count += to < mask.voxels[number]; // masks are binary: newly set voxels
      to = std::max(to, mask.voxels[number]);
    });
    if (&mask != &first)
      result.names.insert(result.names.end(), mask.names.begin(), mask.names.end());
  }
  return result;
}

namespace {

/// Largest sigma, voxels, for which GaussianBlur.h is used. Beyond it, ITK's recursive filter is
/// faster: its time does not depend on sigma.
constexpr double maxKernelSigma = 8.0;

std::vector<std::uint8_t> blurRecursively(const Mask& mask, const Region& region, double sigma) {
  const auto gaussian = itk::SmoothingRecursiveGaussianImageFilter<ItkImage, ItkImage>::New();
  gaussian->SetInput(toItkImage(mask, region));
  gaussian->SetSigma(sigma); // mm
  gaussian->Update();
  const float* const from = gaussian->GetOutput()->GetBufferPointer();
  std::vector<std::uint8_t> result(static_cast<std::size_t>(region.size.prod()));
  std::transform(from, from + result.size(), result.begin(), [](float value) {
    return static_cast<std::uint8_t>(value > 0.0F ? std::min(value, 1.0F) * 255.0F + 0.5F : 0.0F);
  });
  return result;
}

/// Finds voxels of a mask that smoothing erased together with their neighborhood.
class ErasedVoxels {
public:
  /// `first`: voxel of the mask where `smooth` begins.
  ErasedVoxels(const Mask& mask, const Mask& smooth, const Size3& first)
      : m_mask(mask), m_smooth(smooth), m_first(first) {}

  /// Their linear indices in the smoothed mask.
  std::vector<std::size_t> find() const {
    const Size3& size = m_mask.grid.size;
    std::vector<std::vector<std::size_t>> slices(static_cast<std::size_t>(size.z()));
    tbb::parallel_for(std::int64_t{0}, size.z(), [&](std::int64_t z) {
      std::vector<std::size_t>& found = slices[static_cast<std::size_t>(z)];
      for (std::int64_t y = 0; y < size.y(); ++y)
        addRow({0, y, z}, found);
    });
    std::vector<std::size_t> voxels;
    for (const std::vector<std::size_t>& slice : slices)
      voxels.insert(voxels.end(), slice.begin(), slice.end());
    return voxels;
  }

private:
  void addRow(const Size3& start, std::vector<std::size_t>& found) const {
    const std::uint8_t* const row = &m_mask.voxels[linearIndex(start, m_mask.grid.size)];
    const std::size_t there = linearIndex(start - m_first, m_smooth.grid.size);
    const std::uint8_t threshold = m_mask.threshold(), smoothThreshold = m_smooth.threshold();
    for (std::int64_t x = 0; x < m_mask.grid.size.x(); ++x) {
      const std::size_t voxel = there + static_cast<std::size_t>(x);
      if (row[x] >= threshold && m_smooth.voxels[voxel] < smoothThreshold &&
          isEmptyAround(start + Size3(x, 0, 0) - m_first))
        found.push_back(voxel);
    }
  }

  /// True if the smoothed mask is empty at the voxel and its 26 neighbors.
  bool isEmptyAround(const Size3& at) const {
    const Size3& size = m_smooth.grid.size;
    const Size3 lower = (at - Size3::Constant(1)).cwiseMax(0);
    const Size3 upper = (at + Size3::Constant(1)).cwiseMin((size.array() - 1).matrix());
    for (std::int64_t z = lower.z(); z <= upper.z(); ++z)
      for (std::int64_t y = lower.y(); y <= upper.y(); ++y)
        for (std::int64_t x = lower.x(); x <= upper.x(); ++x)
          if (m_smooth.voxels[linearIndex({x, y, z}, size)] >= m_smooth.threshold())
            return false;
    return true;
  }

  const Mask &m_mask, &m_smooth;
  Size3 m_first;
};

} // namespace

Mask smoothMask(const Mask& mask, double sigma, const Grid& volume) {
  if (sigma == 0.0)
    return mask;
  constexpr double maxSigmas = 3.0; // sigmas
  const Region region = padRegion(mask, maxSigmas * sigma, volume);
  const Vec3 sigmas = sigma * mask.grid.spacing().cwiseInverse();
  Mask result = makeRegionMask(mask, region, 255,
                               sigmas.maxCoeff() > maxKernelSigma
                                   ? blurRecursively(mask, region, sigma)
                                   : blurMask(mask, region.first, region.size, sigmas));
  result.smoothing = sigma;
  return result;
}

Mask smoothMaskAuto(const Mask& mask, const Grid& volume) {
  const double sigma = chooseSmoothing(mask.grid);
  if (sigma > maxKernelSigma * mask.grid.spacing().minCoeff())
    return mask; // extremely anisotropic voxels
  Mask result = smoothMask(mask, sigma, volume);
  const Vec3 first = mask.grid.worldToIndex * result.grid.indexToWorld.translation();
  const std::vector<std::size_t> erased =
      ErasedVoxels(mask, result, first.array().round().cast<std::int64_t>()).find();
  for (const std::size_t voxel : erased) {
    result.voxels[voxel] = result.maxValue;
    ++result.count;
  }
  return result;
}

} // namespace fenestra
