#pragma once
// Reads transfer functions: Fenestra's own format and Slicer's volume properties.

#include "model/medium/TransferFunction.h"

#include <filesystem>
#include <map>
#include <string>
#include <string_view>

namespace fenestra {

/// Content of a transfer function file.
struct TransferFile {
  TransferFunction function;
  /// True if scalars have no unit, as in MR and ultrasound; 0 and 1 then stand for the lower and
  /// upper end of a volume's usual range (see mapRange).
  bool isRelative = false;

  /// Function with 0 mapped to `low` and 1 to `high` if relative; otherwise unchanged.
  TransferFunction mapRange(double low, double high) const;
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

} // namespace fenestra
