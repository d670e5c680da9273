#pragma once
// What ITK's linear transforms do, by their names and parameters. For io's own sources.

#include "base/Vector.h"
#include "files/slicer/TransformRecords.h"

namespace fenestra {

/// Whether one of these names (or a composite, whose parts must be).
bool isLinearTransform(const std::string& type);

/// The map that the numbers mean, in the file's own space and sense. Throws Error (input) where
/// they are not as many as the type has; ITK's exceptions where they are not what it allows (a
/// rigid matrix that is not orthogonal).
Affine transformMatrix(const std::filesystem::path& path, const TransformRecord& record);

} // namespace fenestra
