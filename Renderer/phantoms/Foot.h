#pragma once
// A right foot as CT shows it, in Hounsfield units.

#include "phantoms/Phantom.h"

namespace fenestra {

struct FootOptions {
  /// Voxels posterior to anterior, right to left, inferior to superior. The field of view is the
  /// same for every size: 280 x 112 x 140 mm.
  Size3 size{300, 120, 150};
};

/// The same voxels on every run and any number of threads. Voxel axes point anterior, left and
/// superior. Layer 0 has a segment for each of the foot's 26 bones, the stumps of tibia and fibula,
/// and the soft tissues; layer 1 has one, "bones": every voxel of at least 200 HU. Throws Error
/// (usage) where a size is less than 16 or more than 1024.
Phantom makeFootPhantom(const FootOptions& options = {});

/// Ivory bones in translucent skin, fat, muscle and tendon.
VolumeProperty footProperty();

inline constexpr int footBoneThreshold = 200; ///< HU
inline constexpr double footNoise = 14.0;     ///< HU, standard deviation

} // namespace fenestra
