#pragma once
// Eye rays and rays to lights, marched one by one or in SIMD lanes.

#include "transport/lanes/March.h"
#include "transport/readable/March.h"
#include "transport/readable/PathSteps.h"
#include "transport/render/Render.h"

#include <memory>
#include <span>

namespace fenestra {

/// Expected values of one pixel.
struct Met {
  float hit = 0.0F, depth = 0.0F;
  std::array<float, 3> albedo = {}, normal = {}, facing = {};
};

/// A point of the picture through which a ray is marched.
struct RasterPoint {
  double column, row;
};

/// Rays of a picture, marched one by one. along: expected values of eye rays; through:
/// transmittance of rays to lights.
template <typename Voxel>
class MarchedOneByOne {
public:
  MarchedOneByOne(const RenderScene& scene, const Medium<Voxel>& medium)
      : m_scene(scene),
        m_march({scene.volume.grid, scene.crop}, medium, scene.majorants, scene.clip) {}

  void along(std::span<const RasterPoint> points, Met* out) const {
    for (const RasterPoint& point : points) {
      const Ray ray = m_scene.camera.ray(point.column, point.row);
      const FirstMatter first =
          m_march.along(ray, visible(eyeClip(m_scene.clip, m_scene.mixture), ray));
      Met met{narrow(first.hit), narrow(first.distance * m_scene.camera.depthPerLength(ray))};
      met.albedo = narrow3(first.albedo.matrix());
      met.normal = narrow3(first.normal);
      met.facing = narrow3(first.facing);
      *out++ = met;
    }
  }
  void through(std::span<const ShadowRay> rays, float* out) const {
    for (const ShadowRay& shadow : rays)
      *out++ = narrow(m_march.through(shadow.ray, {0.0, shadow.distance}));
  }

private:
  const RenderScene& m_scene;
  March<Voxel> m_march;
};

/// Rays of a picture, marched in lanes, as MarchedOneByOne.
class MarchedInLanes {
public:
  explicit MarchedInLanes(const RenderScene& scene)
      : m_scene(scene),
        m_domain(scene.volume.grid, scene.crop),
        m_volume(SimdTracker(scene.volume, m_domain, scene.transfer, scene.majorants, scene.clip,
                             scene.style, neverStopped, scene.mixture)
                     .scene()),
        m_events(scene.volume.grid, scene.transfer, scene.lights, 0, true, scene.tint,
                 scene.mixture) {
    m_volume.seams = nullptr; // exact surfaces cost more than features gain
  }

  void along(std::span<const RasterPoint> points, Met* out) const {
    const auto batch = std::make_unique<MarchBatch>();
    std::array<double, RayBatch::capacity> before = {}, perLength = {};
    for (std::size_t from = 0; from < points.size(); from += RayBatch::capacity) {
      const std::size_t count = std::min(points.size() - from, RayBatch::capacity);
      batch->rays.size = count;
      for (std::size_t i = 0; i < count; ++i) {
        const Ray ray = m_scene.camera.ray(points[from + i].column, points[from + i].row);
        before[i] = setInside(batch->rays, i, m_domain, ray,
                              visible(eyeClip(m_scene.clip, m_scene.mixture), ray));
        perLength[i] = m_scene.camera.depthPerLength(ray);
      }
      marchAlong(m_volume, m_events, *batch);
      for (std::size_t i = 0; i < count; ++i)
        *out++ = metIn(*batch, i, before[i], perLength[i]);
    }
  }

  void through(std::span<const ShadowRay> rays, float* out) const {
    const auto batch = std::make_unique<RayBatch>();
    for (std::size_t from = 0; from < rays.size(); from += RayBatch::capacity) {
      batch->size = std::min(rays.size() - from, RayBatch::capacity);
      for (std::size_t i = 0; i < batch->size; ++i)
        setInside(*batch, i, m_domain, rays[from + i].ray, {0.0, rays[from + i].distance});
      marchThrough(m_volume, *batch);
      out = std::copy_n(batch->result.begin(), batch->size, out);
    }
  }

private:
  static Met metIn(const MarchBatch& batch, std::size_t i, double before, double perLength) {
    Met met;
    met.hit = batch.hit[i];
    met.depth = narrow((batch.distance[i] + before * batch.hit[i]) * perLength);
    for (std::size_t c = 0; c < 3; ++c) {
      met.albedo[c] = batch.albedo[c][i];
      met.normal[c] = batch.normal[c][i];
      met.facing[c] = batch.facing[c][i];
    }
    return met;
  }

  const RenderScene& m_scene;
  Domain m_domain;
  WideScene m_volume;
  EventScene m_events;
};

} // namespace fenestra
