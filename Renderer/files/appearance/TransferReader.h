#pragma once
// Reads transfer functions: Fenestra's own format and Slicer's volume properties.

#include "model/medium/TransferFunction.h"

#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <string_view>

namespace fenestra::core {

/// Content of a transfer function file.
struct TransferFile {
  TransferFunction function;
  /// What the function's scalars are. MR and ultrasound have no unit: there, scalars are relative
  /// to a volume's range (0: lower end, 1: upper end), or to its tissues (TissueScale).
  enum class Scalars { absolute, relative, tissues } scalars = Scalars::absolute;
  /// Connected opaque parts of a smoothed volume that are smaller than this are made transparent,
  /// mm^3 (scene/VolumeSmoothing.h).
  std::optional<double> islands = {};

  /// Function whose scalars 0, 1, ... are moved to `anchors`, at least two and ascending, linearly
  /// between and beyond them.
  TransferFunction mapScalars(std::span<const double> anchors) const;
};

/// Reads a file by extension: `.vp` (Slicer, text), `.vp.json` (Slicer; first component of the
/// first property), `.json` (Fenestra). Throws Error (input).
TransferFile readTransferFile(const std::filesystem::path& path);
/// Reads a transfer function of absolute scalars. Throws Error (input) for relative ones.
TransferFunction readTransferFunction(const std::filesystem::path& path);

/// Parses a `.json` of either format. `source` identifies the text in messages.
TransferFile parseTransferJson(std::string_view json, const std::string& source);

/// Parses a volume property from the attributes of a scene node; their values have the same form as
/// the lines of a .vp.
TransferFunction parseTransferFunction(const std::map<std::string, std::string>& attributes,
                                       const std::string& source);

} // namespace fenestra::core
