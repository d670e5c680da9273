#pragma once
// Reads the linear transforms that Slicer keeps in files.

#include "base/Vector.h"

#include <filesystem>
#include <string_view>

namespace fenestra {

/// What the file's map is meant as. ITK resamples: its transforms map from the parent, which is
/// what Slicer writes. `toParent` is for old scenes, whose nodes say readAsTransformToParent="1".
enum class TransformSense { fromParent, toParent };

/// The map to the parent, in RAS mm. Files (.tfm .txt .h5 .hdf5 .mat) hold it in LPS, in float or
/// double: any of ITK's linear transforms of three axes about a centre of its own, or a composite
/// of such, the last of which applies first (itk::CompositeTransform). Throws Error (input):
/// anything that is not linear (refused before its parameters are read), several transforms without
/// a composite (Slicer refuses them as well), maps that cannot be inverted, damaged files, files of
/// more than 64 MB, texts of more than 1 MB.
Affine readLinearTransform(const std::filesystem::path& path, TransformSense sense);

/// The same of what reading the file apart answered, which may be anything (TransformRecords.h).
Affine answeredTransform(const std::filesystem::path& path, std::string_view answer,
                         TransformSense sense);

} // namespace fenestra
