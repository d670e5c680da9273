#pragma once
// A scene as the shaders read it: numbers, and tables of 32-bit words. Built from the SIMD
// integrator's tables, so that both have the same floats.

#include "integrator/gpu/Layout.h"
#include "integrator/simd/CameraRays.h"
#include "integrator/simd/Shading.h"

#include <span>
#include <vector>

namespace fenestra::core::gpu {

struct SceneTables {
  SceneTables(const SimdMedium& medium, const SimdShading& shading, const CameraTable& camera,
              const CameraRays& cameraRays, bool isStratified);

  Features features;
  SceneNumbers numbers = {};
  std::vector<std::uint32_t> words;

private:
  Int next() const { return static_cast<Int>(words.size()); } ///< offset of what is appended next
  Int append(float x);
  Int append(Int x);
  Int append(const std::array<float, 3>& v);
  Int appendInts(std::span<const std::int32_t> numbers32);
  Int appendBytes(std::span<const std::uint8_t> bytes);
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
  void setSilhouettes(const SilhouetteCells& silhouettes);
};

} // namespace fenestra::core::gpu
