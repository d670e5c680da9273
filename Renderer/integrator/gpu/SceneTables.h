#pragma once
// A scene as the shaders read it: numbers, and tables of 32-bit words. Built from the SIMD
// integrator's tables, so that both have the same floats.

#include "integrator/gpu/Layout.h"
#include "integrator/simd/CameraRays.h"
#include "integrator/simd/Shading.h"

#include <optional>
#include <string>
#include <vector>

namespace fenestra::core::gpu {

struct SceneTables {
  /// What the shaders lack for a scene that the SIMD integrator supports; none: they support it.
  static std::optional<std::string> findUnsupported(const SimdMedium& medium);

  /// The scene must be supported.
  SceneTables(const SimdMedium& medium, const SimdShading& shading, const CameraTable& camera,
              const CameraRays& cameraRays, bool isStratified);

  Features features;
  SceneNumbers numbers = {};
  std::vector<std::uint32_t> words;

private:
  Int append(float x);
  Int append(Int x);
  Int append(const std::array<float, 3>& v);
  void setVoxels(const SimdMedium& medium);
  void setCells(const SimdMedium& medium);
  void setFunctions(const SimdMedium& medium, const SimdShading& shading);
  Int appendFunctions(const std::vector<SimdTable>& functions);
  void setLabels(const SimdMedium& medium, const SimdShading& shading);
  void setContext(const SimdMedium& medium);
  void setLights(const SimdShading& shading);
  void setMaps(const SimdShading& shading);
  void setCamera(const CameraTable& camera);
  void setClip(const SimdMedium& medium);
};

} // namespace fenestra::core::gpu
