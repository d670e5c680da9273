#pragma once
// Reads linear transforms from Slicer's transform files.

#include "base/Vector.h"
#include "io/Sandbox.h"

#include <filesystem>
#include <string_view>

namespace fenestra::core {

/// Reads the affine map of a file, RAS mm. It maps from the parent, ITK's convention for
/// resampling, which Slicer follows; in some old scenes to the parent
/// (readWriteAsTransformToParent). Files (.tfm .txt .h5 .hdf5 .mat) are in LPS, as float or double.
/// They hold one of ITK's linear 3D transforms, or a composite whose last transform applies first
/// (itk::CompositeTransform). Throws Error (input): nonlinear transforms (rejected before their
/// parameters are read), several transforms without a composite (Slicer rejects them, too),
/// singular maps, damaged files, files over 64 MB, text files over 1 MB.
Affine readLinearTransform(const std::filesystem::path& path);

extern const SandboxJob transformJob;

/// Parses the reply of the child process that read the file: type name, parameters and fixed
/// parameters of each transform (ReplyReader). The reply is untrusted; an empty one means that the
/// file is damaged or the child exceeded its limits.
Affine parseTransformReply(const std::filesystem::path& path, std::string_view reply);

} // namespace fenestra::core
