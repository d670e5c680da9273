#pragma once
// Gray images of a stack, in PNG and TIFF files. libpng and libtiff read them in a sandboxed child
// process (Sandbox.h), since the files are untrusted.

#include "files/medical/SampleSource.h"
#include "io/Sandbox.h"

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>

namespace fenestra::core {

/// Types of samples that a reply can name, by index.
inline const std::array<SampleType, 5> sliceTypes = {std::uint8_t(), std::int8_t(), std::uint16_t(),
                                                     std::int16_t(), float()};

/// Why an image is no slice, as a child's reply says it.
enum class SliceProblem {
  none,
  color,       ///< several samples per pixel, or a color map
  alpha,       ///< gray with transparency
  depth,       ///< another sample type than those of sliceTypes
  large,       ///< more than maxSliceBytes
  tiled,       ///< TIFF: samples in tiles
  inverted,    ///< TIFF: zero is white
  orientation, ///< TIFF: the first sample is not at the top left
};

inline constexpr std::uint64_t maxSliceBytes = 1 << 29;

struct SliceHeader {
  std::uint32_t columns = 0, rows = 0;
  std::size_t type = 0; ///< index in sliceTypes
  bool isLast = true;   ///< no page follows in the file

  std::size_t bytes() const {
    return std::size_t{columns} * rows * bytesPerSample(sliceTypes[type]);
  }
};

/// True for an extension of PNG or TIFF; isTiff: only of TIFF.
bool isSliceFile(const std::filesystem::path& path);
bool isTiff(const std::filesystem::path& path);

/// Reads slices through one child process. Call it from one thread at a time; the first call from
/// one that outlives the object.
class SliceReader {
public:
  SliceReader();

  /// Header of a page of a TIFF, or of a PNG (page 0). Registers the file. Throws Error (input)
  /// that names the file if it is damaged, or is no slice.
  SliceHeader readHeader(const std::filesystem::path& path, std::uint32_t page);

  /// Samples of the page, row by row from the top, in the machine's byte order: header.bytes()
  /// bytes. Throws Error (input) for a damaged or truncated file.
  std::string readSamples(const std::filesystem::path& path, std::uint32_t page,
                          const SliceHeader& header);

private:
  SandboxedReader m_reader;
};

/// What a request asks for; the page (4 bytes) and the path follow.
inline constexpr char sliceHeaderRequest = 'h', sliceSamplesRequest = 's';
extern const SandboxJob sliceJob;

} // namespace fenestra::core
