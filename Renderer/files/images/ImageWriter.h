#pragma once
// Encodes and writes images.

#include "files/images/DisplayTransform.h"
#include "image/Image.h"
#include "io/Outputs.h"

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace fenestra::core {

/// Writes an image in the format that its extension names, to the outputs that declareImage
/// declared:
/// - `.exr`: all channels as 32-bit float, and the header as string attributes "fenestra.<key>".
/// - `.nrrd`: R, G, B, A (A = 1 if missing) as a float vector volume of one slice, which lies on
///   `plane` in world space. If present, Z goes to the scalar volume "<stem>-Z.nrrd", denoised.R,
///   G, B, A to the vector volume "<stem>-denoised.nrrd", and depth50 to the scalar volume
///   "<stem>-depth50.nrrd". The header's "volume" is a key, and in files of depths its "camera".
/// - `.png` (8 bit), `.tif`, `.tiff` (16 bit): R, G, B through the display transform, with straight
///   alpha if any pixel is not opaque, and marks, placed by `plane`. A comment holds tone, exposure
///   and the header's "filter" and "volume".
/// Equal images give equal bytes, and every file has Fenestra's provenance tag. Throws Error:
/// request for another extension or missing R, G, B; output if the file cannot be written.
void writeImage(const Image& image, const ImagePlane& plane, const std::filesystem::path& path,
                Outputs& outputs, const Display& display = {});

/// Interleaved RGBA through the display transform, in [0, 1] with straight alpha, with marks.
/// Requires R, G, B.
std::vector<float> makeDisplayPixels(const Image& image, const ImagePlane& plane,
                                     const Display& display);
/// The same in 8 bits, as in a `.png` file, always with alpha.
std::vector<std::uint8_t> makeDisplayBytes(const Image& image, const ImagePlane& plane,
                                           const Display& display);
/// Interleaved R, G, B and A (1 if missing), with this prefix of the channel names.
std::vector<float> interleaveRgba(const Image& image, const std::string& prefix = "");
/// The same as the bytes of a `.png` file.
std::string encodePng(const Image& image, const ImagePlane& plane, const Display& display);

/// Lists the files that writeImage may write for this path: the path itself and, for `.nrrd`, those
/// of Z, of the denoised image and of depth50. Throws Error (request) for another extension.
std::vector<std::filesystem::path> listImageFiles(const std::filesystem::path& path);

/// Whether the user named the file, or Fenestra chose its default name.
enum class NameOrigin { user, standard };
/// Further files of a `.nrrd`.
struct ExtraFiles {
  bool denoised = false, depth50 = false;
};
/// Declares the files of listImageFiles as outputs, before a long render. Files that the user did
/// not name (the extra `.nrrd` files, default names) only replace files that Fenestra wrote. Throws
/// as Outputs does.
void declareImage(const std::filesystem::path& path, Outputs& outputs,
                  NameOrigin origin = NameOrigin::user, const ExtraFiles& extra = {});

} // namespace fenestra::core
