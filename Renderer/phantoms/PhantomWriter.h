#pragma once
// Writes a phantom as files for Slicer.

#include "phantoms/Phantom.h"

#include <filesystem>
#include <string>
#include <vector>

namespace fenestra::core {

/// Writes into `directory` (created if missing): `name`.nrrd (the volume), .seg.nrrd (the segments,
/// in layers), .vp.json and .vp (the volume property; .vp for Slicer before 5.10), -roi.mrk.json
/// (the volume's box), .mrml (a scene of these) and .mrb (the same as an archive). Files are LPS,
/// identical on every run, and appear all together or not at all. They only replace files that
/// Fenestra wrote: with a provenance tag, with identical content, or beside this phantom's volume
/// and scene. Returns the file names. Throws Error: request for a file that Fenestra did not write;
/// output.
std::vector<std::string> writePhantom(const Phantom& phantom,
                                      const std::filesystem::path& directory,
                                      const std::string& name);

} // namespace fenestra::core
