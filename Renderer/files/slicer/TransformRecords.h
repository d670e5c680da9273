#pragma once
// Content of ITK's transform files: type names and numbers. A child process
// reads the files, since ITK and HDF5 take memory for whatever sizes a file declares, and abort or
// go astray on damage; the parent interprets the numbers.

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace fenestra {

struct TransformRecord {
  std::string type;               ///< ITK's name without scalar type and axes: "AffineTransform"
  std::vector<double> parameters; ///< in the order of ITK's class of that name
  std::vector<double> fixed;      ///< fixed parameters: mostly the centre
};

/// Answer of a child process that reads a .tfm, .txt, .mat, .h5 or .hdf5 file. Throws Error: input
/// where the file is damaged or exceeds the child's limits, output where no process can be started.
std::string transformAnswer(const std::filesystem::path& path);

/// Records in the answer, which is untrusted. Throws Error (input) for a transform that is not
/// linear or not of three axes, std::runtime_error for a malformed answer.
std::vector<TransformRecord> transformRecords(const std::filesystem::path& path,
                                              std::string_view answer);

/// Throws the Error (input) for a damaged transform file.
[[noreturn]] void throwDamagedTransform(const std::filesystem::path& path);

} // namespace fenestra
