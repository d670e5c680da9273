#pragma once
// The device of a test: Mesa's software device, where no other is.

#include "integrator/gpu/Device.h"

#include <cstdlib>
#include <string>

namespace fenestra::core::testing {

/// Why no device can be opened; empty: one can. Admits software devices.
inline std::string findDeviceObstacle() {
  setenv("FENESTRA_GPU", "software", 1);
  try {
    gpu::Device::open();
  } catch (const gpu::DeviceError& error) {
    return error.what();
  }
  return "";
}

/// RenderResult::target of the device.
inline std::string findDeviceTarget() {
  return gpu::Device::open()->info().target();
}

} // namespace fenestra::core::testing
