#pragma once
// Reads the linear transforms that Slicer keeps in files.

#include "base/Vector.h"

#include <filesystem>
#include <string_view>

namespace fenestra {

/// Map that the file holds, RAS mm: from the parent, since ITK's transforms resample, and so
/// Slicer's; in some old scenes to the parent (readWriteAsTransformToParent). Files (.tfm .txt .h5
/// .hdf5 .mat) hold it in LPS, as float or double: any of ITK's linear transforms of three axes, or
/// a composite of such, the last of which applies first (itk::CompositeTransform). Throws Error
/// (input): non-linear transforms (refused before their parameters are read), several transforms
/// without a composite (Slicer refuses them as well), singular maps, damaged files, files of more
/// than 64 MB, texts of more than 1 MB.
Affine readLinearTransform(const std::filesystem::path& path);

/// The map from the answer of a child that read the file: for each transform its type's name,
/// parameters and fixed parameters (ReplyReader). The answer is untrusted; empty: the file is
/// damaged or exceeds the child's limits.
Affine parseTransformReply(const std::filesystem::path& path, std::string_view reply);

} // namespace fenestra
