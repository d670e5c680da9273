#include "model/masks/MaskShaping.h"

#include "base/Error.h"
#include "model/masks/GaussianBlur.h"

#include <itkImage.h>
#include <itkSignedMaurerDistanceMapImageFilter.h>
#include <itkSmoothingRecursiveGaussianImageFilter.h>

#include <algorithm>
#include <array>

namespace fenestra::core {
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
  mask.count = mask.countInside();
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

bool isSameLattice(const Grid& a, const Grid& b) {
  constexpr double most = 0.05; // voxels, of rounding in files
  const Affine aToB = b.worldToIndex * a.indexToWorld;
  const Vec3 begin = aToB.translation(), shift = begin.array().round();
  for (int i = 0; i < 8; ++i) {
    const Vec3 corner = a.indexBox().corner(i);
    if (!((aToB * corner - shift - corner).cwiseAbs().maxCoeff() <= most))
      return false;
  }
  return true;
}

Size3 findOffset(const Mask& mask, const Mask& other) {
  const Vec3 offset = other.grid.worldToIndex * mask.grid.indexToWorld.translation();
  return offset.array().round().cast<std::int64_t>();
}

bool areAdjacent(const Mask& a, const Mask& b) {
  if (!isSameLattice(a.grid, b.grid))
    return false;
  const Size3 offset = findOffset(a, b), one = Size3::Ones();
  const Size3 first = (-offset - one).cwiseMax(0);
  const Size3 end = (b.grid.size - offset + one).cwiseMin(a.grid.size);
  for (std::int64_t z = first.z(); z < end.z(); ++z)
    for (std::int64_t y = first.y(); y < end.y(); ++y)
      for (std::int64_t x = first.x(); x < end.x(); ++x) {
        const Size3 voxel(x, y, z), other = voxel + offset;
        if (a.contains(voxel) &&
            (b.contains(other) || std::ranges::any_of(std::array{0, 1, 2}, [&](int axis) {
               return b.contains(other - Size3::Unit(axis)) ||
                      b.contains(other + Size3::Unit(axis));
             })))
          return true;
      }
  return false;
}

Mask uniteMasks(std::vector<Mask> masks) {
  if (masks.size() == 1)
    return std::move(masks.front());
  const Mask& first = masks.front();
  // Region of a mask in the voxels of the first mask.
  const auto findRegion = [&](const Mask& mask) {
    return Region{findOffset(mask, first), mask.grid.size};
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

} // namespace fenestra::core
