#pragma once
// Phantom as the files that Slicer opens.

#include "phantoms/Phantom.h"

#include <filesystem>
#include <string>
#include <vector>

namespace fenestra {

/// Writes into `directory` (made if missing): `name`.nrrd (the volume), .seg.nrrd (the segments, in
/// their layers), .vp.json and .vp (the volume property; the second for Slicers before 5.10),
/// -roi.mrk.json (the volume's box), .mrml (a scene of these) and .mrb (the same in an archive).
/// Files are LPS, the same bytes on every run, and appear together or not at all. They replace only
/// what Fenestra wrote: files that bear its mark, that have the same bytes, or that lie with this
/// phantom's volume and scene. Returns their names. Throws Error: usage where a file is somebody
/// else's; output.
std::vector<std::string> writePhantom(const Phantom& phantom,
                                      const std::filesystem::path& directory,
                                      const std::string& name);

} // namespace fenestra
