#pragma once
// ITK's transform files as they are: a list of type names and numbers. For io's own sources. They
// are not read by ITK's classes, which take memory for whatever sizes a file declares, open further
// files that it names, and do not check how many parameters there are.

#include <filesystem>
#include <string>
#include <vector>

namespace fenestra {

struct TransformRecord {
  std::string type;               ///< without scalar type and axes: "AffineTransform"
  std::vector<double> parameters; ///< as ITK's class of that name orders them
  std::vector<double> fixed;      ///< the centre, mostly
};

/// More parameters than any linear transform has.
inline constexpr std::size_t mostParameters = 64;
inline constexpr std::size_t mostRecords = 256;

/// A record without its numbers from "Type_scalar_axes_axes"; throws Error (input) unless the
/// type is linear and of three axes.
TransformRecord transformRecord(const std::filesystem::path& path, const std::string& name);

/// Each throws Error (input) where the file is damaged or holds what is not linear.
std::vector<TransformRecord> readTransformText(const std::filesystem::path& path);   // .tfm .txt
std::vector<TransformRecord> readTransformMatlab(const std::filesystem::path& path); // .mat
std::vector<TransformRecord> readTransformHdf5(const std::filesystem::path& path);   // .h5 .hdf5

/// What all of them say of a file that makes no sense.
[[noreturn]] void throwDamagedTransform(const std::filesystem::path& path);

} // namespace fenestra
