#pragma once
// Camera rays and shadow rays of an image, traced by the scalar or the SIMD ray marcher.

#include "denoise/features/RayMarcher.h"
#include "denoise/features/SimdRayMarcher.h"
#include "integrator/render/Render.h"
#include "integrator/scalar/PathSteps.h"

#include <limits>
#include <memory>
#include <span>

namespace fenestra::core {

/// Expected values of one camera ray or pixel (FeatureBuffers).
struct PrimaryHit {
  float hit = 0.0F, depth = 0.0F;
  float depth50 = std::numeric_limits<float>::infinity();
  std::array<float, 3> albedo = {}, normal = {}, surfaceNormal = {};
};

/// Raster position of a camera ray.
struct RasterPoint {
  double column, row;
};

/// Scalar ray marcher. integrateHits: expected values of camera rays; computeTransmittance: of
/// shadow rays.
template <typename Voxel>
class ScalarFeatureMarcher {
public:
  ScalarFeatureMarcher(const SceneView& scene, const Medium<Voxel>& medium)
      : m_scene(scene),
        m_march({scene.volume.grid, scene.crop}, medium, scene.majorants, scene.clip) {}

  void integrateHits(std::span<const RasterPoint> points, PrimaryHit* out) const {
    for (const RasterPoint& point : points) {
      const Ray ray = m_scene.camera.makeRay(point.column, point.row);
      const ExpectedHit first = m_march.integrateHits(
          ray, visibleInterval(cameraRayClip(m_scene.clip, m_scene.mixture), ray));
      const double perLength = m_scene.camera.depthPerLength(ray);
      PrimaryHit primary{narrow(first.hit), narrow(first.distance * perLength),
                         narrow(first.distance50 * perLength)};
      primary.albedo = narrow3(first.albedo.matrix());
      primary.normal = narrow3(first.normal);
      primary.surfaceNormal = narrow3(first.surfaceNormal);
      *out++ = primary;
    }
  }
  void computeTransmittance(std::span<const ShadowRay> rays, float* out) const {
    for (const ShadowRay& shadow : rays)
      *out++ = narrow(m_march.computeTransmittance(shadow.ray, {0.0, shadow.distance}));
  }

private:
  const SceneView& m_scene;
  RayMarcher<Voxel> m_march;
};

/// SIMD ray marcher, with the interface of ScalarFeatureMarcher.
class SimdFeatureMarcher {
public:
  explicit SimdFeatureMarcher(const SceneView& scene)
      : m_scene(scene),
        m_domain(scene.volume.grid, scene.crop),
        m_medium(SimdTracker(scene.volume, m_domain, scene.transfer, scene.majorants, scene.clip,
                             scene.style, neverStopped, scene.mixture)
                     .medium()),
        m_shading(scene.volume.grid, scene.transfer, scene.lights, 0, true, scene.tint,
                  scene.mixture) {}

  void integrateHits(std::span<const RasterPoint> points, PrimaryHit* out) const {
    const auto batch = std::make_unique<MarchBatch>();
    std::array<double, RayBatch::capacity> before = {}, perLength = {};
    for (std::size_t from = 0; from < points.size(); from += RayBatch::capacity) {
      const std::size_t count = std::min(points.size() - from, RayBatch::capacity);
      batch->rays.size = count;
      for (std::size_t i = 0; i < count; ++i) {
        const Ray ray = m_scene.camera.makeRay(points[from + i].column, points[from + i].row);
        before[i] =
            setDomainRay(batch->rays, i, m_domain, ray,
                         visibleInterval(cameraRayClip(m_scene.clip, m_scene.mixture), ray));
        perLength[i] = m_scene.camera.depthPerLength(ray);
      }
      marchCameraRays(m_medium, m_shading, *batch);
      for (std::size_t i = 0; i < count; ++i)
        *out++ = toPrimaryHit(*batch, i, before[i], perLength[i]);
    }
  }

  void computeTransmittance(std::span<const ShadowRay> rays, float* out) const {
    const auto batch = std::make_unique<RayBatch>();
    for (std::size_t from = 0; from < rays.size(); from += RayBatch::capacity) {
      batch->size = std::min(rays.size() - from, RayBatch::capacity);
      for (std::size_t i = 0; i < batch->size; ++i)
        setDomainRay(*batch, i, m_domain, rays[from + i].ray, {0.0, rays[from + i].distance});
      marchShadowRays(m_medium, *batch);
      out = std::copy_n(batch->result.begin(), batch->size, out);
    }
  }

private:
  static PrimaryHit toPrimaryHit(const MarchBatch& batch, std::size_t i, double before,
                                 double perLength) {
    PrimaryHit primary;
    primary.hit = batch.hit[i];
    primary.depth = narrow((batch.distance[i] + before * batch.hit[i]) * perLength);
    primary.depth50 = narrow((batch.distance50[i] + before) * perLength);
    for (std::size_t c = 0; c < 3; ++c) {
      primary.albedo[c] = batch.albedo[c][i];
      primary.normal[c] = batch.normal[c][i];
      primary.surfaceNormal[c] = batch.surfaceNormal[c][i];
    }
    return primary;
  }

  const SceneView& m_scene;
  Domain m_domain;
  SimdMedium m_medium;
  SimdShading m_shading;
};

} // namespace fenestra::core
