#pragma once
// Right foot as CT shows it, in Hounsfield units.

#include "phantoms/Phantom.h"

namespace fenestra {

struct FootOptions {
  /// Voxels posterior to anterior, right to left, inferior to superior.
  /// Field of view: 280 x 112 x 140 mm for every size.
  Size3 size{300, 120, 150};
};

/// Right foot. Voxels do not depend on run or number of threads. Voxel axes point anterior, left
/// and superior. Layer 0 has a segment for each of the foot's 26 bones, the stumps of tibia and
/// fibula, and the soft tissues; layer 1 has the segment "bones": every voxel of at least 200 HU.
/// Throws Error (usage) if a size < 16 or > 1024.
Phantom makeFootPhantom(const FootOptions& options = {});

} // namespace fenestra
