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

/// What a process of its own says of a .tfm, .txt, .mat, .h5 or .hdf5 file. Throws Error (input)
/// where the file is damaged or takes more to read than it may, Error (output) where no process can
/// be started.
std::string transformAnswer(const std::filesystem::path& path);

/// The records in that, which may be anything. Throws Error (input) where one is not linear and of
/// three axes, std::runtime_error where there are no records.
std::vector<TransformRecord> transformRecords(const std::filesystem::path& path,
                                              std::string_view answer);

/// What all say of a file that makes no sense.
[[noreturn]] void throwDamagedTransform(const std::filesystem::path& path);

} // namespace fenestra
