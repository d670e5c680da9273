#pragma once
// Camera rays, on which paths start, and the background behind the volume.

#include "clip/field/Clip.h"
#include "image/Film.h"
#include "model/camera/Background.h"
#include "model/lights/LightSet.h"
#include "model/medium/Mixture.h"

#include <vector>

namespace fenestra::core {

/// Clip that shortens camera rays. If a mixture has unclipped components, rays are not shortened:
/// such components may lie in front of the clipping surface.
inline const Clip& cameraRayClip(const Clip& clip, const Mixture* mixture) {
  static const Clip none = ClipNone();
  return mixture && mixture->hasUnclipped() ? none : clip;
}

/// Non-owning: camera, clip (cameraRayClip), lights and background must outlive the object.
class CameraRays {
public:
  CameraRays(const Camera& camera, const Clip& clip, const LightSet& lights,
             const Background& background)
      : m_camera(camera), m_clip(clip), m_lights(lights), m_background(background) {
    if (background.kind == Background::Kind::gradient)
      for (int row = 0; row < camera.height(); ++row)
        m_gradient.push_back(background.evaluate(1.0 - (row + 0.5) / camera.height()));
  }

  /// Camera ray through raster position (column, row).
  Ray ray(double column, double row) const { return m_camera.makeRay(column, row); }
  /// True if the clip shortens no camera ray.
  bool isUnclipped() const { return std::holds_alternative<ClipNone>(m_clip); }
  /// Part of a camera ray on which the clip weight can be above 0.
  Interval range(const Ray& ray) const { return visibleInterval(m_clip, ray); }
  /// View-space depth at `distance` along a camera ray, mm.
  double depth(const Ray& ray, double distance) const {
    return distance * m_camera.depthPerLength(ray);
  }

  /// Sample of a camera ray without collision: the background. A gradient is constant over a row of
  /// pixels, so the sample's position within the pixel adds no noise.
  PathSample sampleBackground(double row, const Vec3& direction) const {
    PathSample sample;
    switch (m_background.kind) {
    case Background::Kind::color:
      sample.radiance = m_background.color;
      break;
    case Background::Kind::gradient:
      sample.radiance = m_gradient[static_cast<std::size_t>(row)];
      break;
    case Background::Kind::transparent:
      sample.alpha = 0.0;
      break;
    case Background::Kind::environment:
      sample.radiance = m_lights.evaluateEnvironment(direction).radiance;
      break;
    }
    return sample;
  }

private:
  const Camera& m_camera;
  const Clip& m_clip;
  const LightSet& m_lights;
  const Background& m_background;
  std::vector<Rgb> m_gradient; ///< one color per row; empty unless the background is a gradient
};

} // namespace fenestra::core
