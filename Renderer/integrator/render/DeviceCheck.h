#pragma once
// Checks a GPU before each render: some paths are also traced by the SIMD integrator, from the same
// random numbers. Results are equal up to rounding, except where rounding changes a decision along
// a path. If a driver has compiled the shader wrongly, most differ.

#include "integrator/gpu/DeviceIntegrator.h"
#include "integrator/simd/PathIntegrator.h"

namespace fenestra::core {

/// Throws gpu::DeviceError if fewer than half of the probes that collide agree. Returns at once if
/// stopped.
void checkDevice(const gpu::DeviceIntegrator& device, const SimdPathIntegrator& simd,
                 const Camera& camera, const Sampler& sampler);

} // namespace fenestra::core
