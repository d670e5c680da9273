#pragma once
// A right knee as a T1-weighted sagittal MR scan shows it, with every structure a segment.

#include "phantoms/Phantom.h"

namespace fenestra {

struct KneeOptions {
  /// Voxels anterior to posterior, superior to inferior, left to right. The field of view is the
  /// same for every size: 120 x 137.6 x 120 mm.
  Size3 size{300, 344, 120};
};

/// The same voxels on every run and any number of threads. Voxel axes point posterior, inferior and
/// right. The femoral cartilage has a full-thickness lesion on the medial condyle and one of half
/// its depth on the lateral. Throws Error (usage) where a size is less than 16 or more than 1024.
Phantom makeKneePhantom(const KneeOptions& options = {});

/// Shows the knee in natural colours: pearly cartilage, yellow fat and marrow, red muscle.
VolumeProperty kneeProperty();

} // namespace fenestra
