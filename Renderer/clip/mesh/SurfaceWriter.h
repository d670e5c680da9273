#pragma once
// Writes surfaces for other programs.

#include "clip/mesh/SurfaceMesh.h"
#include "io/Outputs.h"

#include <filesystem>

namespace fenestra {

/// Writes a surface in the format that the extension names, into a result that declareSurface
/// declared; in RAS mm, stated as in Slicer's files (SPACE=RAS):
/// - `.vtp`: VTK XML, points as doubles, depths as point data "depth".
/// - `.ply`: binary, little endian, floats, depths as a property "depth" of the vertices.
/// - `.stl`: binary, floats, no depths.
/// Equal surfaces give equal bytes. Throws Error: usage for another extension; output where the
/// file cannot be written.
void writeSurface(const SurfaceMesh& surface, const std::filesystem::path& path, Outputs& outputs);

/// Declares the file, before a long render. Throws Error (usage) for another extension, and as
/// Outputs does.
void declareSurface(const std::filesystem::path& path, Outputs& outputs);

} // namespace fenestra
