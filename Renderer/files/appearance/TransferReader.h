#pragma once
// Reads transfer functions: Fenestra's own, and Slicer's volume properties.

#include "model/medium/TransferFunction.h"

#include <filesystem>
#include <map>
#include <string>
#include <string_view>

namespace fenestra {

/// Transfer function, and whether its scalars have a unit.
struct TransferFile {
  TransferFunction function;
  /// True: scalars without a unit, as in MR and ultrasound; 0 and 1 stand for the least and the
  /// greatest usual value of a volume (see `over`).
  bool isRelative = false;

  /// Function with 0 moved to `low` and 1 to `high` if relative; unchanged otherwise.
  TransferFunction mapRange(double low, double high) const;
};

/// Reads by extension: `.vp` (Slicer, text), `.vp.json` (Slicer; its first property's first
/// component), `.json` (Fenestra). Throws Error (input).
TransferFile readTransferFile(const std::filesystem::path& path);
/// Reads a transfer function of absolute scalars. Throws Error (input) for relative ones.
TransferFunction readTransferFunction(const std::filesystem::path& path);

/// Parses a `.json` of either kind. `source` names the text in messages.
TransferFile parseTransferJson(std::string_view json, const std::string& source);

/// Parses a volume property from the attributes of a scene's node, whose values have the form of a
/// .vp's lines.
TransferFunction parseTransferFunction(const std::map<std::string, std::string>& attributes,
                                       const std::string& source);

} // namespace fenestra
