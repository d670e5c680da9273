#pragma once
// Matrices of ITK's linear transforms, by type name and parameters.

#include "base/Vector.h"
#include "files/slicer/TransformRecords.h"

namespace fenestra {

/// True for the name of a linear transform, or of a composite (whose parts must be linear).
bool isLinearTransform(const std::string& type);

/// Map of the record, in the file's own space and sense. Throws Error (input) for a wrong number of
/// parameters; ITK's exceptions for values that the type forbids (a rigid matrix that is not
/// orthogonal).
Affine transformMatrix(const std::filesystem::path& path, const TransformRecord& record);

} // namespace fenestra
