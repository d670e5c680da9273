// Traces the paths of a batch. Each thread takes path after path until none is left, or its steps
// are used up: then the next dispatch resumes it.
#version 450
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require

layout(local_size_x = 64) in;

layout(constant_id = 0) const int voxelKind = 0; ///< 0 uint8, 1 int16, 2 uint16, 3 float
layout(constant_id = 1) const int isCropped = 0;
layout(constant_id = 2) const int isStratified = 0;
layout(constant_id = 3) const int hasSampledLights = 0;
layout(constant_id = 4) const int skyCount = 0;
layout(constant_id = 5) const int directionalCount = 0;
layout(constant_id = 6) const int areaCount = 0;
layout(constant_id = 7) const int sphereCount = 0;
layout(constant_id = 8) const int isHybrid = 0;
layout(constant_id = 9) const int isSobel = 0;
layout(constant_id = 10) const int isCoated = 0;
layout(constant_id = 11) const int wantNormals = 0;
layout(constant_id = 12) const int clipKind = 0; ///< 0 none, 1 plane, 2 depth linear, 3 depth nearest
layout(constant_id = 13) const int clipsCameraRays = 0;
layout(constant_id = 14) const int mapCount = 0;
layout(constant_id = 15) const int componentKind = 0; ///< 0 one, 1 tinted, 2 mixed
layout(constant_id = 16) const int hasUnclipped = 0;
layout(constant_id = 17) const int hasContext = 0;
layout(constant_id = 18) const int hasSilhouettes = 0;

#include "formulas/Types.glsl"
#include "formulas/Vectors.inl"
#include "formulas/Random.inl"
#include "formulas/Uniforms.inl"
#include "formulas/Exponential.inl"
#include "formulas/Interpolation.inl"
#include "formulas/CellCubic.inl"
#include "formulas/ClipTable.inl"
#include "formulas/Clip.inl"
#include "formulas/Scattering.inl"
#include "formulas/LightTables.inl"
#include "formulas/Lights.inl"
#include "formulas/Environment.inl"
#include "formulas/Paths.inl"
#include "formulas/Tracking.inl"

#define INOUT(T) inout T
#define largestReal uintBitsToFloat(0x7f7fffffu)
bool isNaN(float x) {
  return (floatBitsToUint(x) & 0x7fffffffu) > 0x7f800000u;
}

#include "integrator/gpu/shaders/Scene.inl"
#include "integrator/gpu/shaders/Batch.inl"

layout(std430, binding = 0) readonly buffer SceneBuffer {
  SceneNumbers scene;
};
layout(std430, binding = 1) readonly buffer TableBuffer {
  uint tables[];
};
layout(binding = 2) uniform utexture3D voxels;
layout(std430, binding = 3) readonly buffer StartBuffer {
  PathStart starts[];
};
layout(std430, binding = 4) writeonly buffer ResultBuffer {
  vec4 results[];
};

layout(binding = 7) uniform utexture3D focus;

layout(push_constant) uniform Push {
  int pathCount, maxSteps;
};

uint counts[workKinds];

float loadFloat(int at) {
  return uintBitsToFloat(tables[at]);
}
int loadInt(int at) {
  return int(tables[at]);
}
float loadVoxel(int x, int y, int z) {
  const uint bits = texelFetch(voxels, ivec3(x, y, z), 0).x;
  if (voxelKind == 3)
    return uintBitsToFloat(bits);
  if (voxelKind == 1)
    return float((int(bits) << 16) >> 16);
  return float(bits);
}
int loadByte(int at) {
  return int(tables[at >> 2] >> uint(8 * (at & 3))) & 0xff;
}
float loadFocus(int x, int y, int z) {
  return float(texelFetch(focus, ivec3(x, y, z), 0).x);
}
PathStart loadStart(int path) {
  return starts[path];
}
void storeResult(int path, int part, vec3 v, float w) {
  results[path * 3 + part] = vec4(v, w);
}
void countWork(int kind) {
  ++counts[kind];
}

#include "integrator/gpu/shaders/Medium.inl"
#include "integrator/gpu/shaders/Silhouettes.inl"
#include "integrator/gpu/shaders/Clip.inl"
#include "integrator/gpu/shaders/Labels.inl"
#include "integrator/gpu/shaders/Maps.inl"
#include "integrator/gpu/shaders/Lights.inl"
#include "integrator/gpu/shaders/Path.inl"

layout(std430, binding = 5) buffer StateBuffer {
  PathState states[];
};
layout(std430, binding = 6) buffer WorkBuffer {
  int nextPath;  ///< the first that no thread has taken
  uint unfinished; ///< threads whose path has not ended
  uint work[workKinds];
};

void main() {
  const uint thread = gl_GlobalInvocationID.x;
  for (int i = 0; i < workKinds; ++i)
    counts[i] = 0u;
  PathState state = states[thread];
  Walk walk = makeWalk(state.origin, state.ray);
  for (int step = 0; step < maxSteps; ++step) {
    if (state.phase == idle) {
      const int path = atomicAdd(nextPath, 1);
      if (path >= pathCount)
        break;
      startPath(state, path);
      walk = makeWalk(state.origin, state.ray);
    }
    advance(state, walk);
  }
  states[thread] = state;
  if (state.phase != idle)
    atomicAdd(unfinished, 1u);
  for (int i = 0; i < workKinds; ++i)
    if (counts[i] > 0u)
      atomicAdd(work[i], counts[i]);
}
