#pragma once
// Reads the linear transforms that Slicer keeps in files.

#include "base/Vector.h"

#include <filesystem>
#include <string_view>

namespace fenestra {

/// Direction of the file's map. `fromParent`: ITK's, which resamples, and so Slicer's. `toParent`:
/// that of some old scenes (readWriteAsTransformToParent).
enum class TransformSense { fromParent, toParent };

/// Map to the parent, RAS mm. Files (.tfm .txt .h5 .hdf5 .mat) hold it in LPS, as float or double:
/// any of ITK's linear transforms of three axes, or a composite of such, the last of which applies
/// first (itk::CompositeTransform). Throws Error (input): non-linear transforms (refused before
/// their parameters are read), several transforms without a composite (Slicer refuses them as
/// well), singular maps, damaged files, files of more than 64 MB, texts of more than 1 MB.
Affine readLinearTransform(const std::filesystem::path& path, TransformSense sense);

/// Map to the parent from the answer of a child that read the file; the answer is untrusted
/// (TransformAnswer.h).
Affine answeredTransform(const std::filesystem::path& path, std::string_view answer,
                         TransformSense sense);

} // namespace fenestra
