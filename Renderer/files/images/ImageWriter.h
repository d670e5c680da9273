#pragma once
// Writes finished pictures.

#include "files/images/DisplayTransform.h"
#include "image/Image.h"
#include "io/Outputs.h"

#include <filesystem>
#include <string>
#include <vector>

namespace fenestra {

/// Writes a picture in the format that the extension names, into results that declareImage
/// declared:
/// - `.exr`: every channel as 32-bit float, and the header as string attributes "fenestra.<key>".
/// - `.nrrd`: R, G, B, A (1 without A) as a float vector volume of one slice that lies on `plane`
///   in the world; beside it, where present, Z as a scalar volume, "<stem>-Z.nrrd", and denoised.R,
///   G, B, A as another vector volume, "<stem>-denoised.nrrd".
/// - `.png` (8 bit), `.tif`, `.tiff` (16 bit): R, G, B as `display` shows them, with straight alpha
///   if any pixel is not opaque; tone, exposure and the header's "filter" as a comment.
/// Equal pictures give equal bytes, and all bear Fenestra's mark. Throws Error: usage for another
/// extension or missing R, G, B; output where the file cannot be written.
void writeImage(const Image& image, const ImagePlane& plane, const std::filesystem::path& path,
                Outputs& outputs, const Display& display = {});

/// Files that writeImage may make for this path: itself, and the depth and the filtered colours
/// beside a `.nrrd`. Throws Error (usage) for another extension.
std::vector<std::filesystem::path> listImageFiles(const std::filesystem::path& path);

enum class NameOrigin { user, standard };
/// Whether pictures have filtered channels.
enum class HasDenoised { no, yes };
/// Declares the files of listImageFiles, before a long render. Pictures beside a `.nrrd`, and a
/// picture with its standard name, replace only files that Fenestra wrote. Throws as Outputs does.
void declareImage(const std::filesystem::path& path, Outputs& outputs,
                  NameOrigin origin = NameOrigin::user, HasDenoised hasDenoised = HasDenoised::no);

} // namespace fenestra
