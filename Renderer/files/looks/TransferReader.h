#pragma once
// Reads transfer functions: Fenestra's own, and Slicer's volume properties.

#include "model/medium/TransferFunction.h"

#include <filesystem>
#include <map>
#include <string>
#include <string_view>

namespace fenestra {

/// A transfer function, and what its scalars are.
struct TransferLook {
  TransferFunction function;
  /// Of no unit, as in MR and ultrasound: 0 stands for the least value that is usual in a volume,
  /// 1 for the greatest, and `over` makes a medium of it.
  bool relative = false;

  /// The function with 0 at `low` and 1 at `high` where it is relative, else as it is.
  TransferFunction over(double low, double high) const;
};

/// By extension: `.vp` (Slicer, text), `.vp.json` (Slicer; its first property's first component),
/// `.json` (Fenestra). Throws Error (input).
TransferLook readTransferLook(const std::filesystem::path& path);
/// The same where scalars have to be a volume's own. Throws Error (input) where they are relative.
TransferFunction readTransferFunction(const std::filesystem::path& path);

/// The text of a `.json` of either kind. `source` names it in messages.
TransferLook parseTransferLook(std::string_view json, const std::string& source);
TransferFunction parseTransferFunction(std::string_view json, const std::string& source);

/// A volume property as the attributes of a scene's node, which have the names and forms of a
/// .vp's lines.
TransferFunction parseTransferFunction(const std::map<std::string, std::string>& attributes,
                                       const std::string& source);

} // namespace fenestra
