#pragma once
// Volumes stored as images: a folder of PNG or TIFF slices, or the pages of one TIFF file.
//
// Such files state neither spacing nor orientation. As in ITK and 3D Slicer, a stack has the
// identity as its directions in LPS: columns go toward left, rows toward posterior, slices toward
// superior, and the center of the first sample is the origin.

#include "files/medical/SliceFile.h"
#include "files/medical/VolumeChoice.h"
#include "model/volume/Volume.h"

#include <cstdint>
#include <filesystem>
#include <vector>

namespace fenestra::core {

struct ImageStack {
  struct Slice {
    std::filesystem::path file;
    std::uint32_t page = 0;
  };

  std::filesystem::path path;     ///< the folder or file
  std::vector<Slice> slices = {}; ///< the lowest first; at least one
  SliceHeader header = {};        ///< of every slice
  std::vector<Message> warnings = {};

  Size3 size() const;
  /// Without repetitions, in the order of the slices.
  std::vector<std::filesystem::path> files() const;
};

/// True for a TIFF file, and for a folder of slices: it has at least two PNG or TIFF files, or one
/// and no subfolder, and no DICOM or other volume file. Hidden files do not count.
bool isImageStack(const std::filesystem::path& path);

/// Reads the headers of all slices, which are in the natural order of their names: slice2 before
/// slice10. Warns if the last numbers of the names are not evenly spaced. Throws Error (input) that
/// names the file for damaged files, color images, slices of unequal size or type, a single slice,
/// and for PNG and TIFF files in one folder.
ImageStack openImageStack(const std::filesystem::path& path);

/// Reads the volume of the slices, one slice at a time, with a warning about the assumed axes.
/// Throws Error (input) if the choice has no spacing, for damaged files, and before memory is
/// allocated for more samples than the files or the machine's memory can hold.
Volume readImageStack(const ImageStack& stack, const VolumeChoice& choice);

} // namespace fenestra::core
