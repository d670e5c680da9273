#pragma once
// A fetus of some 28 weeks as obstetric ultrasound shows it: the head, from in front.

#include "phantoms/Phantom.h"

namespace fenestra {

struct FetusOptions {
  /// Voxels right to left, anterior to posterior, inferior to superior, of the fetus. The field of
  /// view is the same for every size: 112 x 112 x 112 mm.
  Size3 size{160, 160, 160};
};

/// The same voxels on every run and any number of threads. Values are 0 to 255, with speckle and
/// shadows as sound leaves them. The face, with a hand beside it, is a segment, which the wall of
/// the uterus and a loop of the cord hide from in front. Throws Error (usage) where a size is less
/// than 16 or more than 1024.
Phantom makeFetusPhantom(const FetusOptions& options = {});

/// Skin tones; fluid is transparent.
VolumeProperty fetusProperty();

} // namespace fenestra
