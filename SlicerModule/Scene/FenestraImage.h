#pragma once
// Volumes exchanged between Slicer and the renderer: raw NRRD, without a copy in memory. Needs
// neither Slicer nor VTK: built and tested everywhere, usable in any thread.

#include <array>
#include <cstddef>
#include <filesystem>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>

namespace SlicerExport {

/// Row-major; columns are in mm.
using Matrix = std::array<double, 16>;
constexpr Matrix identity = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};

/// Failure to write or read a file; the message names the file and the reason.
struct FileError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

struct Image {
  std::string type;                            ///< component type as in NRRD: "int16", "float"
  std::array<std::size_t, 3> size = {0, 0, 0}; ///< voxels along i, j, k
  std::size_t components = 1;                  ///< per voxel, interleaved
  Matrix ijkToRas = identity;                  ///< mm; maps voxel centers
  std::shared_ptr<const void> data;            ///< i varies fastest
  /// Further key-value fields of the NRRD header.
  std::map<std::string, std::string> fields;

  std::size_t bytes() const;
};

/// Bytes of a component type; 0: not an NRRD type.
std::size_t componentBytes(const std::string& type);

/// Error for a file that could not be written just now; the reason is that of `errno`.
FileError makeWriteError(const std::filesystem::path& file);

/// Writes raw data in this machine's byte order. Throws FileError; then no file is left.
void writeNrrd(const Image& image, const std::filesystem::path& file);

/// Reads NRRD as the renderer writes it: raw, three dimensions, preceded by components if any.
/// Throws FileError.
Image readNrrd(const std::filesystem::path& file);

} // namespace SlicerExport
