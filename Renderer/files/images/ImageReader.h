#pragma once
// Reads images: renderings to compare, references, environment maps.

#include "image/Image.h"

#include <filesystem>

namespace fenestra::core {

/// Reads an image in the format that its extension names; row 0 is at the top.
/// - `.exr`: all channels of the first part's data window, as float, and the header attributes
///   "fenestra.<key>".
/// - `.nrrd`: one slice as writeImage writes it; channels R, G, B, A for four components, R, G, B
///   for three, Z for one.
/// - `.png`, `.tif`, `.tiff`: R, G, B and, if present, A as display values in [0, 1], neither
///   decoded nor premultiplied. Gray is copied to R, G, B.
/// Throws Error (input) for other extensions, damaged or incomplete files, sides over 32768 pixels,
/// more pixels than the file can hold, or more than 2^28 samples over all channels.
Image readImage(const std::filesystem::path& path);

} // namespace fenestra::core
