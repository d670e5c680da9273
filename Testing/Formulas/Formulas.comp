// Compiles every formula as GLSL: syntax and types. No number is computed.
#version 450
#extension GL_GOOGLE_include_directive : require

layout(local_size_x = 64) in;
layout(std430, binding = 0) buffer Numbers {
  float numbers[];
};

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

void main() {
  numbers[0] = toUniform(floatBitsToUint(numbers[1]));
}
