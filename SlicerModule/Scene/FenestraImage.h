#pragma once
// Volumes as Slicer hands them to the renderer and gets them back: raw NRRD, without a copy in
// memory. No Slicer, no VTK, so that it is built and tested everywhere, and can run in any thread.

#include <array>
#include <cstddef>
#include <filesystem>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>

namespace FenestraScene {

/// Row by row; columns are in mm.
using Matrix = std::array<double, 16>;
constexpr Matrix identity = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};

/// A file could not be written or read; says which and why.
struct FileError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

struct Image {
  std::string type;                            ///< of a component, NRRD's word: "int16", "float"
  std::array<std::size_t, 3> size = {0, 0, 0}; ///< voxels along i, j, k
  std::size_t components = 1;                  ///< of a voxel, side by side
  Matrix ijkToRas = identity;                  ///< of voxel centres
  std::shared_ptr<const void> data;            ///< i runs fastest
  /// Of the NRRD header, beyond geometry: key to value.
  std::map<std::string, std::string> fields;

  std::size_t bytes() const;
};

/// Bytes of a component type; 0 for a word that NRRD does not have.
std::size_t bytesOf(const std::string& type);

/// Raw, this machine's order of bytes. Throws FileError; the file is whole or not there.
void writeNrrd(const Image& image, const std::filesystem::path& file);

/// What the renderer writes: three dimensions and, ahead of them, any components; raw. Throws
/// FileError.
Image readNrrd(const std::filesystem::path& file);

} // namespace FenestraScene
