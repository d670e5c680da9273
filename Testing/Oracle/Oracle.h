#pragma once
// Renders images with the oracle.

#include "Estimates.h"
#include "OracleScene.h"

namespace fenestra::core::oracle {

/// Traces `samples` independent paths per pixel. `depths` receives a depth clip's buffer
/// (Clipping.h). Throws std::invalid_argument for a gradient background.
Estimates render(const OracleScene& scene, std::uint64_t samples, std::uint64_t seed,
                 std::vector<double>* depths = nullptr);

} // namespace fenestra::core::oracle
