#pragma once
// ITK's transform files as they are: a list of type names and numbers. For io's own sources. ITK
// reads them in a process of its own, for it and HDF5 take memory for whatever sizes a file
// declares, and abort or go astray where it is damaged; what the numbers mean is told here.

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace fenestra {

struct TransformRecord {
  std::string type;               ///< without scalar type and axes: "AffineTransform"
  std::vector<double> parameters; ///< as ITK's class of that name orders them
  std::vector<double> fixed;      ///< the centre, mostly
};

/// Of a .tfm, .txt, .mat, .h5 or .hdf5 file. Throws Error (input) where the file is damaged, takes
/// more to read than it may, or holds what is not linear and of three axes; Error (output) where no
/// process can be started.
std::vector<TransformRecord> readTransformRecords(const std::filesystem::path& path);

/// The records of what the process answered, which may be anything; throws as above.
std::vector<TransformRecord> transformRecords(const std::filesystem::path& path,
                                              std::string_view answer);

/// What all say of a file that makes no sense.
[[noreturn]] void throwDamagedTransform(const std::filesystem::path& path);

} // namespace fenestra
