#pragma once
// A phantom as the files that Slicer opens.

#include "phantom/Phantom.h"

#include <filesystem>
#include <string>

namespace fenestra {

/// Writes into `directory`, which is made where it is missing: `baseName`.nrrd (the volume),
/// .seg.nrrd (one layer of all segments) and .vp.json (the volume property). Files are LPS, and
/// each appears whole or not at all. Throws Error (output).
void writePhantom(const Phantom& phantom, const std::filesystem::path& directory,
                  const std::string& baseName);

} // namespace fenestra
