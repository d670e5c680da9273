#pragma once
// What renders may use of this machine.

#include "render/Render.h"

#include <tbb/global_control.h>

namespace fenestra {

/// Holds all work to the threads that were asked for, at most one a core, for as long as it lives;
/// and pins the instruction set that the environment variable FENESTRA_INSTRUCTIONS names. Throws
/// Error (usage) where this machine does not have it.
class MachineUse {
public:
  explicit MachineUse(const RenderSettings& settings);

private:
  tbb::global_control m_threads;
};

} // namespace fenestra
