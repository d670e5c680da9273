#pragma once
// NRRD files of three axes in space and one of time. ITK refuses those whose space has three
// dimensions, takes a first axis of time for one in space, and does not know RAST from LPST.

#include "base/Affine.h"
#include "files/medical/MedicalHeader.h"
#include "files/medical/SampleSource.h"
#include "model/volume/Grid.h"

#include <filesystem>
#include <optional>

namespace fenestra::core {

struct NrrdFrames {
  Size3 size;
  Affine indexToRas;
  SampleType type;
  std::size_t count = 1;      ///< frames
  bool isInterleaved = false; ///< the frames of a voxel are adjacent; else the voxels of a frame
  bool hasSpaceTime = false;  ///< the space has a dimension of time, too
};

/// Interprets the header. nullopt: there is no such time axis, or ITK places the file rightly,
/// since it has no space and the time axis is the last. `spacing`: of a file that states none;
/// empty: 1. Throws Error (input) if time is neither the first nor the last axis, or the geometry
/// is not complete.
std::optional<NrrdFrames> findNrrdFrames(const std::filesystem::path& path,
                                         const std::optional<Vec3>& spacing);

/// Source of the samples of all frames. Throws Error (input) for text and several data files, and
/// if the file is too short.
SampleSource openNrrdFrames(const std::filesystem::path& path, const StoredSamples& stored,
                            const NrrdFrames& frames);

} // namespace fenestra::core
