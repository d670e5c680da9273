#include "denoise/features/Denoising.h"

#include "base/Distribution.h"

#include <algorithm>
#include <stdexcept>

namespace fenestra::core {
namespace {

/// Pixels that the denoiser changes. It skips deterministic pixels, and those around which no
/// camera ray hits anything, so that no window blurs a silhouette into the background. The mask
/// must not depend on the samples: their noise would bias the error estimate.
std::vector<std::uint8_t> findActivePixels(const Film& film, const FeatureBuffers& features) {
  std::vector<std::uint8_t> isActive(film.pixelCount());
  for (int row = 0; row < film.height(); ++row)
    for (int column = 0; column < film.width(); ++column) {
      bool isEmpty = true;
      for (int y = std::max(row - 1, 0); y <= std::min(row + 1, film.height() - 1); ++y)
        for (int x = std::max(column - 1, 0); x <= std::min(column + 1, film.width() - 1); ++x)
          isEmpty = isEmpty && features.hit[film.index(x, y)] == 0.0F;
      isActive[film.index(column, row)] = !isEmpty && !film.at(column, row).isDeterministic;
    }
  return isActive;
}

/// Fills the half buffers. Inactive pixels, and films without halves, get the mean in both.
void fillHalfBuffers(const Film& film, FilterInput& input) {
  const std::size_t count = film.pixelCount();
  for (std::size_t c = 0; c < 4; ++c) {
    input.even[c].resize(count);
    input.odd[c].resize(count);
    if (c < 3)
      input.variance[c].resize(count);
  }
  for (std::size_t i = 0; i < count; ++i) {
    const PixelSums& pixel = film.pixels()[i];
    const double alpha =
        pixel.alpha / static_cast<double>(std::max<std::uint64_t>(pixel.samples, 1));
    const HalfMeans half = input.hasHalfBuffers && input.isActive[i]
                               ? pixel.halfMeans()
                               : HalfMeans{pixel.mean, pixel.mean, alpha, alpha};
    const Rgb variance = pixel.standardError().square();
    for (std::size_t c = 0; c < 3; ++c) {
      const auto channel = static_cast<int>(c);
      input.even[c][i] = static_cast<float>(half.even[channel]);
      input.odd[c][i] = static_cast<float>(half.odd[channel]);
      input.variance[c][i] = static_cast<float>(variance[channel]);
    }
    input.even[3][i] = static_cast<float>(half.evenAlpha);
    input.odd[3][i] = static_cast<float>(half.oddAlpha);
  }
}

/// Depth sums relative to the median depth, mm, so that pixels with little coverage get small
/// values.
Plane centerDepth(const FeatureBuffers& features) {
  std::vector<float> depths;
  for (std::size_t i = 0; i < features.hit.size(); ++i)
    if (features.hit[i] > 0.5F)
      depths.push_back(features.depth[i] / features.hit[i]);
  if (depths.empty())
    return features.depth;
  const float middle = findMedian(depths);
  Plane plane = features.depth;
  for (std::size_t i = 0; i < plane.size(); ++i)
    plane[i] -= middle * features.hit[i];
  return plane;
}

/// Central differences between the two neighboring pixels; 0 at the edge of the image.
Plane computeSlope(const Plane& plane, int width, int height, bool down) {
  Plane slope(plane.size(), 0.0F);
  const auto row = static_cast<std::size_t>(width);
  const std::size_t step = down ? row : 1;
  for (int y = down ? 1 : 0; y < height - (down ? 1 : 0); ++y)
    for (int x = down ? 0 : 1; x < width - (down ? 0 : 1); ++x) {
      const std::size_t i = static_cast<std::size_t>(y) * row + static_cast<std::size_t>(x);
      slope[i] = plane[i + step] - plane[i - step];
    }
  return slope;
}

/// Clip depth, with gaps filled from the previous pixel in the row. Gaps are where the clip removes
/// the complete ray.
Plane fillClipDepth(const Camera& camera, const Clip& clip) {
  Plane plane = makeClipDepth(camera, clip);
  float last = static_cast<float>(camera.targetDepth());
  for (float& depth : plane)
    depth = last = std::isfinite(depth) ? depth : last;
  return plane;
}

void addFeatures(const SceneView& scene, const FeatureBuffers& features, FilterInput& input) {
  for (const Plane& plane : features.albedo)
    input.features.push_back(plane);
  // With surface shading, `surfaceNormal` weights normals by the probability of surface scattering.
  for (const Plane& plane : scene.transfer.shading ? features.surfaceNormal : features.normal)
    input.features.push_back(plane);
  input.features.push_back(features.light);
  const Plane depth = centerDepth(features);
  input.features.push_back(computeSlope(depth, input.width, input.height, false));
  input.features.push_back(computeSlope(depth, input.width, input.height, true));
  input.features.push_back(depth);
  if (!std::holds_alternative<ClipNone>(scene.clip))
    input.features.push_back(fillClipDepth(scene.camera, scene.clip));
}

bool hasHalfBuffers(const Film& film) {
  return std::ranges::all_of(film.pixels(), [](const PixelSums& pixel) {
    return pixel.isDeterministic || pixel.samples > 1;
  });
}

} // namespace

FilterInput makeFilterInput(const Film& film, const SceneView& scene,
                            const FeatureBuffers& features) {
  if (!film.hasIndependentHalves())
    throw std::logic_error("a film without independent halves cannot be denoised");
  FilterInput input{film.width(), film.height(), {}, {}, {}, {}, {}, hasHalfBuffers(film)};
  input.isActive = findActivePixels(film, features);
  fillHalfBuffers(film, input);
  addFeatures(scene, features, input);
  return input;
}

} // namespace fenestra::core
