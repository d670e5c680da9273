#pragma once
// An image in a file that other processes map into their memory, replaced in place by the next:
// faster than files that are encoded, renamed and read. For previews.
//
// The file is an array of 64-bit little-endian words. The first 64 are its header:
//
//     0  "FENFRAME"
//     1  version, 1
//     2  sequence: 0 before the first image, odd while an image is being written
//     3  size of the file in bytes, which may grow with an image
//     4  request: FrameInfo::request
//     5  width of the image, pixels               6  height
//     7  width at full resolution, pixels         8  height
//     9  samples per pixel
//    10  noise: double; NaN: unknown             11  the same after denoising
//    12  1: last image of the request, else 0
//    13  number of layers, at most 8
//    14  4 words per layer: name (8 characters, padded with 0); offset in bytes, a multiple of 8;
//        components per pixel; bytes per component (4: float, 1: unsigned integer)
//    46  camera, as doubles: position, target and up direction (x, y, z each), RAS mm
//    55  1: orthographic, 0: perspective
//    56  double: half the height of the image in mm, or its vertical angle in degrees
//
// Layers have row 0 at the top and no padding between pixels. A reader (acquire order) reads the
// sequence, then what it needs, then the sequence again: if both are equal and even, all is of one
// image. Else it tries again, soon or at the next message of the writer.

#include "image/Image.h"
#include "io/Outputs.h"
#include "io/platform/MappedFile.h"

#include <cstdint>
#include <span>

namespace fenestra::core {

struct FrameCamera {
  Vec3 position, target, up; ///< RAS, mm
  bool isOrthographic;
  double extent; ///< half the height of the image, mm; perspective: its vertical angle, degrees
};

struct FrameInfo {
  std::int64_t request = -1; ///< id of the change that the image shows; -1: none, or not an integer
  int width = 0, height = 0;
  int fullWidth = 0, fullHeight = 0; ///< of the image at full resolution
  std::uint64_t samples = 0;         ///< per pixel
  double noise, denoisedNoise;       ///< NaN: unknown
  bool isLast = false;               ///< of the request
  FrameCamera camera;
};

/// One layer: `values` holds width * height * components numbers of `bytesPerValue` bytes.
struct FrameLayer {
  std::string_view name; ///< at most 8 characters
  int components, bytesPerValue;
  std::span<const std::byte> values;
};

/// Writes such a file. One writer per file; its name stays when the writer ends.
class FrameFile {
public:
  /// Replaces the file `path`, declared in `outputs`, by one without an image. Throws Error
  /// (output).
  FrameFile(const std::filesystem::path& path, Outputs& outputs);

  /// Replaces the image. Requires at most 8 layers. Throws Error (output); the image before then
  /// stays.
  void publish(const FrameInfo& info, std::span<const FrameLayer> layers);

private:
  void store(std::size_t word, std::uint64_t value);
  void store(std::size_t word, std::span<const std::byte> bytes);

  MappedFile m_file;
  std::uint64_t m_sequence = 0;
};

} // namespace fenestra::core
