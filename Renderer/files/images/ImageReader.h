#pragma once
// Reads pictures: renders to compare, references, environment maps.

#include "image/Image.h"

#include <filesystem>

namespace fenestra {

/// Reads a picture, row 0 at the top, by its extension:
/// - `.exr`: every channel of the (first) part's data window, converted to float, and the header's
///   attributes "fenestra.<key>".
/// - `.nrrd`: one slice as writeImage writes it: R, G, B, A of four components, R, G, B of three, Z
///   of one.
/// - `.png`, `.tif`, `.tiff`: R, G, B and, if present, A as display values in [0, 1], neither
///   decoded nor premultiplied; grey is copied to R, G, B.
/// Throws Error (input) for other extensions, damaged or incomplete files, more than 32768 pixels a
/// side, more pixels than the file can hold, or more than 2^28 samples in all channels.
Image readImage(const std::filesystem::path& path);

} // namespace fenestra
