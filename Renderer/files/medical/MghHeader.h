#pragma once
// Header of a FreeSurfer volume (.mgh, .mgz).

#include "files/medical/NiftiHeader.h"

namespace fenestra::core {

inline constexpr std::size_t mghHeaderBytes = 284;

/// Parses the first mghHeaderBytes of a file. Without its own directions, voxels are placed as
/// FreeSurfer does: coronal slices of 1 mm around the origin, with a warning. Throws Error (input),
/// naming `path`, for other headers and sample types.
NiftiHeader parseMghHeader(std::string_view bytes, const std::filesystem::path& path);

} // namespace fenestra::core
