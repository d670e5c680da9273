#pragma once
// Reads transfer functions: Fenestra's own, and Slicer's volume properties.

#include "medium/TransferFunction.h"

#include <filesystem>
#include <map>
#include <string>
#include <string_view>

namespace fenestra {

/// By extension: `.vp` (Slicer, text), `.vp.json` (Slicer; its first property's first component),
/// `.json` (Fenestra). Throws Error (input).
TransferFunction readTransferFunction(const std::filesystem::path& path);

/// The text of a `.json` of either kind. `source` names it in messages.
TransferFunction parseTransferFunction(std::string_view json, const std::string& source);

/// A volume property as the attributes of a scene's node, which have the names and forms of a
/// .vp's lines.
TransferFunction parseTransferFunction(const std::map<std::string, std::string>& attributes,
                                       const std::string& source);

} // namespace fenestra
