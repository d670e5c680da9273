#include "denoise/features/FeatureBuffers.h"

#include "denoise/features/FeatureMarchers.h"

#include <tbb/parallel_for.h>

namespace fenestra::core {
namespace {

/// Image of primary hits, row 0 at the top.
struct Raster {
  int width, height;
  std::vector<PrimaryHit> pixels;

  std::size_t index(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(width) +
           static_cast<std::size_t>(column);
  }
};

/// True if two neighboring pixels differ by more than fixed thresholds. `pitch`: mm between pixels.
bool areDifferent(const PrimaryHit& a, const PrimaryHit& b, double pitch) {
  constexpr float maxChange = 0.08F, maxSlope = 4.0F; // of albedo and hit; of depth
  const auto isFar = [&](std::size_t c) { return std::abs(a.albedo[c] - b.albedo[c]) > maxChange; };
  if (isFar(0) || isFar(1) || isFar(2) || std::abs(a.hit - b.hit) > maxChange)
    return true;
  const float both = std::min(a.hit, b.hit);
  return both > 0.0F &&
         std::abs(a.depth / a.hit - b.depth / b.hit) * both > maxSlope * static_cast<float>(pitch);
}

bool isAtEdge(const Raster& raster, int column, int row, double pitch) {
  const PrimaryHit& here = raster.pixels[raster.index(column, row)];
  const auto isUnlike = [&](int x, int y) {
    return x >= 0 && y >= 0 && x < raster.width && y < raster.height &&
           areDifferent(here, raster.pixels[raster.index(x, y)], pitch);
  };
  return isUnlike(column - 1, row) || isUnlike(column + 1, row) || isUnlike(column, row - 1) ||
         isUnlike(column, row + 1);
}

PrimaryHit average(std::span<const PrimaryHit> parts) {
  PrimaryHit mean;
  const float weight = 1.0F / static_cast<float>(parts.size());
  for (const PrimaryHit& part : parts) {
    mean.hit += weight * part.hit;
    mean.depth += weight * part.depth;
    for (std::size_t c = 0; c < 3; ++c) {
      mean.albedo[c] += weight * part.albedo[c];
      mean.normal[c] += weight * part.normal[c];
      mean.surfaceNormal[c] += weight * part.surfaceNormal[c];
    }
  }
  return mean;
}

/// Calls work(row) for each row of the image, until `stop` is true.
template <typename Work>
void forEachRow(int rows, const StopFlag& stop, const Work& work) {
  tbb::parallel_for(0, rows, [&](int row) {
    if (!stop.load(std::memory_order_relaxed))
      work(row);
  });
}

template <typename March>
Raster marchPixels(const Camera& camera, const March& march, FeatureEffort effort,
                   const StopFlag& stop) {
  const int width = camera.width(), height = camera.height();
  Raster raster{width, height, {}};
  raster.pixels.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  forEachRow(height, stop, [&](int row) {
    std::vector<RasterPoint> centers;
    for (int column = 0; column < width; ++column)
      centers.push_back({column + 0.5, row + 0.5});
    march.integrateHits(centers, &raster.pixels[raster.index(0, row)]);
  });
  if (effort == FeatureEffort::draft)
    return raster;
  std::vector<std::vector<int>> edges(static_cast<std::size_t>(height)); // columns
  forEachRow(height, stop, [&](int row) {
    for (int column = 0; column < width; ++column)
      if (isAtEdge(raster, column, row, camera.pixelPitch()))
        edges[static_cast<std::size_t>(row)].push_back(column);
  });
  forEachRow(height, stop, [&](int row) {
    std::vector<RasterPoint> points;
    for (const int column : edges[static_cast<std::size_t>(row)])
      for (const double y : {0.25, 0.75})
        for (const double x : {0.25, 0.75})
          points.push_back({column + x, row + y});
    std::vector<PrimaryHit> parts(points.size());
    march.integrateHits(points, parts.data());
    std::span<const PrimaryHit> left = parts;
    for (const int column : edges[static_cast<std::size_t>(row)]) {
      PrimaryHit& pixel = raster.pixels[raster.index(column, row)];
      const float depth50 = pixel.depth50;
      pixel = average(left.first(4));
      pixel.depth50 = depth50;
      left = left.subspan(4);
    }
  });
  return raster;
}

/// Direct light at the mean collisions of an image's pixels.
template <typename Voxel, typename March>
class DirectLight {
public:
  /// `samples`: of the lights, per point.
  DirectLight(const SceneView& scene, const Medium<Voxel>& medium, const March& march, int samples)
      : m_scene(scene), m_medium(medium), m_march(march), m_samples(samples) {}

  Plane compute(const Raster& raster, const StopFlag& stop) const {
    Plane light(raster.pixels.size(), 0.0F);
    forEachRow(raster.height, stop, [&](int row) { addRow(raster, row, light); });
    return light;
  }

private:
  /// Mean collision of a pixel.
  struct Collision {
    std::size_t pixel;
    Vec3 point, incoming;
    MediumSample medium;
    double hit;
  };

  void addRow(const Raster& raster, int row, Plane& light) const {
    const std::vector<Collision> collisions = findCollisions(raster, row);
    std::vector<ShadowRay> rays;
    std::vector<std::size_t> pixels;
    for (int sample = 0; sample < m_samples; ++sample) // so that neighboring rays are similar
      for (const Collision& at : collisions)
        if (const auto ray = makeShadowRay(at, sample)) {
          rays.push_back(*ray);
          pixels.push_back(at.pixel);
        }
    std::vector<float> transmittance(rays.size());
    m_march.computeTransmittance(rays, transmittance.data());
    for (std::size_t i = 0; i < rays.size(); ++i)
      light[pixels[i]] += transmittance[i] * narrow(rays[i].radiance.mean());
  }

  std::vector<Collision> findCollisions(const Raster& raster, int row) const {
    constexpr float minHit = 0.02F;
    std::vector<Collision> collisions;
    for (int column = 0; column < raster.width; ++column) {
      const std::size_t pixel = raster.index(column, row);
      const PrimaryHit& primary = raster.pixels[pixel];
      if (!(primary.hit > minHit))
        continue;
      const Ray cameraRay = m_scene.camera.makeRay(column + 0.5, row + 0.5);
      const double depth = static_cast<double>(primary.depth / primary.hit);
      const Vec3 point = cameraRay.at(depth / m_scene.camera.depthPerLength(cameraRay));
      const Vec3 index = m_scene.volume.grid.worldToIndex * point;
      if (const auto medium = findLikeliest(point, index))
        collisions.push_back(
            {pixel, point, cameraRay.direction, *medium, static_cast<double>(primary.hit)});
    }
    return collisions;
  }

  /// The medium that a collision samples with the highest probability.
  std::optional<MediumSample> findLikeliest(const Vec3& point, const Vec3& index) const {
    std::optional<MediumSample> found;
    double best = 0.0;
    forEachMediumSample(m_medium, m_scene.clip, point, index, true,
                        [&](const MediumSample& medium, double probability) {
                          if (probability <= best)
                            return;
                          found = medium;
                          best = probability;
                        });
    return found;
  }

  /// All points use the same random numbers: integration errors vary smoothly and are not noise.
  std::optional<ShadowRay> makeShadowRay(const Collision& at, int sample) const {
    Random random(0, 0, static_cast<std::uint64_t>(sample));
    const double choice = (sample + random.uniform()) / m_samples;
    const auto light = m_scene.lights.sample(at.point, choice, random.uniform2());
    if (!light)
      return std::nullopt;
    const double probability = at.medium.surfaceProbability;
    Rgb factor = Rgb::Zero();
    const auto add = [&](double weight, const Scattering& scattering) {
      factor += weight * toColor(scattering.evaluate(light->direction).factor);
    };
    if (probability < 1.0)
      add(1.0 - probability, {at.incoming, at.medium.transfer->g, at.medium.albedo});
    if (probability > 0.0)
      add(probability,
          {at.incoming, at.medium.gradient, *at.medium.transfer->shading, at.medium.albedo});
    const Rgb radiance = factor * light->radiance * (at.hit / (light->pdf * m_samples));
    if (!(radiance.maxCoeff() > 0.0))
      return std::nullopt;
    return ShadowRay{{at.point, light->direction}, light->distance, radiance};
  }

  const SceneView& m_scene;
  const Medium<Voxel>& m_medium;
  const March& m_march;
  const int m_samples;
};

FeatureBuffers toFeatures(const Raster& raster) {
  FeatureBuffers features;
  const auto fill = [&](Plane& values, auto&& getValue) {
    values.reserve(raster.pixels.size());
    for (const PrimaryHit& primary : raster.pixels)
      values.push_back(getValue(primary));
  };
  fill(features.hit, [](const PrimaryHit& primary) { return primary.hit; });
  fill(features.depth, [](const PrimaryHit& primary) { return primary.depth; });
  fill(features.depth50, [](const PrimaryHit& primary) { return primary.depth50; });
  for (std::size_t c = 0; c < 3; ++c) {
    fill(features.albedo[c], [c](const PrimaryHit& primary) { return primary.albedo[c]; });
    fill(features.normal[c], [c](const PrimaryHit& primary) { return primary.normal[c]; });
    fill(features.surfaceNormal[c],
         [c](const PrimaryHit& primary) { return primary.surfaceNormal[c]; });
  }
  return features;
}

template <typename Voxel, typename March>
FeatureBuffers marchFeatures(const SceneView& scene, const Medium<Voxel>& medium,
                             const March& march, FeatureEffort effort, const StopFlag& stop) {
  const Raster raster = marchPixels(scene.camera, march, effort, stop);
  FeatureBuffers features = toFeatures(raster);
  const int samples = effort == FeatureEffort::draft ? 1 : 4;
  features.light = DirectLight<Voxel, March>(scene, medium, march, samples).compute(raster, stop);
  return features;
}

} // namespace

FeatureBuffers computeFeatures(const SceneView& scene, FeatureEffort effort, const StopFlag& stop) {
  if (!canUseSimd(scene))
    return computeScalarFeatures(scene, effort, stop);
  return withMedium(scene, [&]<typename Voxel>(const Medium<Voxel>& medium, const Tracker<Voxel>&) {
    return marchFeatures(scene, medium, SimdFeatureMarcher(scene), effort, stop);
  });
}

FeatureBuffers computeScalarFeatures(const SceneView& scene, FeatureEffort effort,
                                     const StopFlag& stop) {
  return withMedium(scene, [&]<typename Voxel>(const Medium<Voxel>& medium, const Tracker<Voxel>&) {
    return marchFeatures(scene, medium, ScalarFeatureMarcher<Voxel>(scene, medium), effort, stop);
  });
}

} // namespace fenestra::core
