#pragma once
// One surface of a VTK XML file (.vtp), as Slicer writes it: data inline, as text or base64, plain
// or deflated. For io's own sources. Not read by VTK, which trusts the sizes that a file declares.

#include "base/Vector.h"

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace fenestra {

struct VtkSurface {
  std::vector<Vec3> points;                            ///< in the file's space
  std::vector<std::array<std::uint32_t, 3>> triangles; ///< of its polygons and strips
  bool hasLines = false;
  std::map<std::string, std::string> texts;           ///< field data: the first of each array
  std::map<std::string, std::vector<double>> numbers; ///< field data
};

/// Bytes that files which belong together may still take, as texts and as numbers: deflated arrays
/// grow a thousandfold, and a file may be named often.
struct SurfaceAllowance {
  std::uint64_t bytes = std::uint64_t{1} << 30;
};

/// Throws Error (input) where the file is damaged, of another type, or holds more than its bytes
/// can, or than the allowance, from which it takes its own. Of the field data only the arrays named
/// `fieldData` are looked into.
VtkSurface readVtkSurface(const std::filesystem::path& path, const std::set<std::string>& fieldData,
                          SurfaceAllowance& allowance);

} // namespace fenestra
