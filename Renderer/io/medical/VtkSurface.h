#pragma once
// One surface of a VTK XML file (.vtp), as Slicer writes it: data inline, as text or base64, plain
// or deflated. For io's own sources. Not read by VTK, which trusts the sizes that a file declares.

#include "core/Vector.h"

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
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

/// Throws Error (input) where the file is damaged, of another type, or holds more than its bytes
/// can.
VtkSurface readVtkSurface(const std::filesystem::path& path);

} // namespace fenestra
