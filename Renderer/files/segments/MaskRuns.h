#pragma once
// Reads the mask of one structure as runs of voxels, without storing the image: masks are mostly
// empty, and a folder of them may have more than a hundred on the grid of the scan.

#include "base/Error.h"
#include "files/medical/SampleSource.h"
#include "files/medical/VolumeChoice.h"
#include "files/segments/NativeGrid.h"
#include "model/volume/Grid.h"

#include <filesystem>
#include <optional>
#include <utility>
#include <vector>

namespace fenestra::core {

/// Consecutive voxels of a row, by linear index.
struct MaskRun {
  std::int64_t begin, end;
};

struct MaskRuns {
  Grid grid;
  std::vector<MaskRun> runs = {}; ///< in ascending order
  std::vector<Message> warnings = {};
};

/// True if the samples are no integers and are from 0 to 1, up to rounding.
bool isProbability(const SampleStats& samples);

/// Runs of the samples of a mask with rows of `width` voxels: all other than 0 have one value, or
/// they are probabilities, of which those of at least 1/2 are taken. nullopt: it is no mask.
std::optional<std::vector<MaskRun>> readMaskRuns(const SampleSource& source, std::int64_t width);

/// Reads a mask: an image in which all voxels other than 0 have one value, or a probability map
/// with values from 0 to 1, of which the voxels of at least 1/2 are taken. `choice`: of the NIfTI
/// form. Throws Error (input) for any other image.
MaskRuns readMask(const std::filesystem::path& path, const VolumeChoice& choice = {});

/// Labels the mask with `value` in its bounding box, which is extended by one voxel where the grid
/// continues; also returns the grid of the box. Without voxels it is the first voxel of the grid.
std::pair<Grid, Labels> labelMask(const MaskRuns& mask, std::int32_t value);

} // namespace fenestra::core
