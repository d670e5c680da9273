#pragma once
// One frame out of the samples of several.

#include "files/medical/SampleSource.h"

namespace fenestra::core {

/// A frame of a file. Frames are stored one after the other, or interleaved: voxel by voxel.
struct FrameChoice {
  std::size_t count = 1; ///< frames in the file
  std::size_t frame = 0; ///< below `count`
  bool isInterleaved = false;
};

/// Source of the samples of one frame, from that of all frames, of which nothing is read yet. Skips
/// the others; the end of a stream is checked only if the frame is at the end.
SampleSource pickFrame(SampleSource all, const FrameChoice& choice);

} // namespace fenestra::core
