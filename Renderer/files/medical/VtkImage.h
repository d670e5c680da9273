#pragma once
// VTK XML images (.vti): one piece with one scalar array, on points or cells.

#include "base/Affine.h"
#include "files/medical/SampleSource.h"
#include "model/volume/Grid.h"

#include <filesystem>
#include <optional>

namespace fenestra::core {

struct VtkImage {
  Size3 size;
  Affine indexToWorld;    ///< voxel centers, in the file's space
  bool hasSpacing = true; ///< the file states the spacing
  SampleSource samples;
};

/// Reads the header: the active scalars, else the only array, of the points, else of the cells,
/// whose centers are the voxels. `spacing`: of a file that states none; empty: 1. The data may be
/// text, or raw or base64 bytes, plain or deflated by zlib, in both byte orders. Reading the
/// samples throws VtkArrayError if they are damaged. Throws Error (input) for other files, several
/// pieces or components, and more samples than the file can hold.
VtkImage openVtkImage(const std::filesystem::path& path, const std::optional<Vec3>& spacing = {});

} // namespace fenestra::core
