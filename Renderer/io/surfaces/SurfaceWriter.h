#pragma once
// Writes surfaces for other programs.

#include "clipping/SurfaceMesh.h"

#include <filesystem>

namespace fenestra {

/// Writes a surface in the format that the extension names, atomically; in RAS mm, which the file
/// says as Slicer's own do (SPACE=RAS):
/// - `.vtp`: VTK XML, points as doubles, depths as point data "depth".
/// - `.ply`: binary, little endian, floats, depths as a property "depth" of the vertices.
/// - `.stl`: binary, floats, no depths.
/// Equal surfaces give equal bytes. Throws Error: usage for another extension; output where the
/// file cannot be written.
void writeSurface(const SurfaceMesh& surface, const std::filesystem::path& path);

/// Throws what writeSurface would throw for this path alone: for asking before a long render.
void checkSurfacePath(const std::filesystem::path& path);

} // namespace fenestra
