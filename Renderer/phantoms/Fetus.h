#pragma once
// Fetus of about 28 weeks as obstetric ultrasound shows it: the head, from in front.

#include "phantoms/Phantom.h"

namespace fenestra {

struct FetusOptions {
  /// Voxels right to left, anterior to posterior, inferior to superior, of the fetus.
  /// Field of view: 112 x 112 x 112 mm for every size.
  Size3 size{160, 160, 160};
};

/// Fetal head. Voxels do not depend on run or number of threads. Values are 0 to 255, with speckle
/// and shadows of ultrasound. The face, with a hand beside it, is one segment, hidden from in front
/// by the uterine wall and a loop of the cord. Throws Error (usage) if a size < 16 or > 1024.
Phantom makeFetusPhantom(const FetusOptions& options = {});

} // namespace fenestra
