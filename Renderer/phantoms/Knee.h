#pragma once
// Right knee as a T1-weighted sagittal MR scan shows it; every structure is a segment.

#include "phantoms/Phantom.h"

namespace fenestra {

struct KneeOptions {
  /// Voxels anterior to posterior, superior to inferior, left to right.
  /// Field of view: 120 x 137.6 x 120 mm for every size.
  Size3 size{300, 344, 120};
};

/// Right knee. Voxels do not depend on run or number of threads. Voxel axes point posterior,
/// inferior and right. The femoral cartilage has a full-thickness lesion on the medial slope of the
/// trochlea and a half-thickness lesion on the lateral condyle. Throws Error (usage) if a size < 16
/// or > 1024.
Phantom makeKneePhantom(const KneeOptions& options = {});

/// Natural colours: pearly cartilage, yellow fat and marrow, red muscle.
VolumeProperty kneeProperty();

} // namespace fenestra
