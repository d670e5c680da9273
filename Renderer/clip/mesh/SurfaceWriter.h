#pragma once
// Writes surface meshes as VTP, PLY and STL.

#include "clip/mesh/SurfaceMesh.h"
#include "io/Outputs.h"

#include <filesystem>

namespace fenestra::core {

/// Writes a surface, declared by declareSurface, in the format given by the extension. Coordinates
/// are RAS mm, stated as in Slicer's files (SPACE=RAS):
/// - `.vtp`: VTK XML, points as doubles, depths (if any) as point data "depth".
/// - `.ply`: binary, little endian, floats, depths (if any) as a property "depth" of the vertices.
/// - `.stl`: binary, floats, no depths.
/// Equal surfaces give equal bytes. Throws Error: (request) for other extensions, (output) if the
/// file cannot be written.
void writeSurface(const SurfaceMesh& surface, const std::filesystem::path& path, Outputs& outputs);

/// Declares the output file before a long render. Throws Error (request) for other extensions, and
/// as Outputs does.
void declareSurface(const std::filesystem::path& path, Outputs& outputs);

} // namespace fenestra::core
