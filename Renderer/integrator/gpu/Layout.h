#pragma once
// Numbers that the shaders read and write, as C++ structs of the same layout.

#include "base/Formulas.h"
#include "integrator/simd/Medium.h"

#include <array>
#include <cstddef>
#include <cstdint>

namespace fenestra::core::gpu {

using Real = float;
using Float = float;
using Int = std::int32_t;
using UInt = std::uint32_t;
using ClipTable = single::ClipTable;

#include "integrator/gpu/shaders/Batch.inl"
#include "integrator/gpu/shaders/Scene.inl"

static_assert(offsetof(SceneNumbers, clip) % 16 == 0);

/// Constants of a shader's specialization: constant_id is the place in this struct.
struct Features {
  Int voxelKind = 0; ///< 0 uint8, 1 int16, 2 uint16, 3 float
  Int isCropped = 0, isStratified = 0;
  Int hasSampledLights = 0;
  Int skyCount = 0, directionalCount = 0, areaCount = 0, sphereCount = 0;
  Int isHybrid = 0, isSobel = 0, isCoated = 0, wantNormals = 0;
  Int clipKind = 0; ///< SimdMedium::ClipKind
  Int clipsCameraRays = 0;
  Int mapCount = 0;
  Int componentKind = 0; ///< 0 one, 1 tinted, 2 mixed
  Int hasUnclipped = 0, hasContext = 0, hasSilhouettes = 0;
};

} // namespace fenestra::core::gpu
