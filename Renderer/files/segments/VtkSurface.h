#pragma once
// Reads one surface from a VTK XML file (.vtp) as Slicer writes it: inline data, as text or base64,
// plain or deflated. VTK's own reader trusts the sizes that a file declares, so it is not used.

#include "base/Vector.h"

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace fenestra::core {

struct VtkSurface {
  std::vector<Vec3> points;                            ///< in the file's space
  std::vector<std::array<std::uint32_t, 3>> triangles; ///< of polygons and strips
  bool hasLines = false;
  std::map<std::string, std::string> texts;           ///< field data: first string of each array
  std::map<std::string, std::vector<double>> numbers; ///< field data
};

/// Remaining memory for a group of related files. Deflated arrays can expand a thousandfold, and a
/// .vtm may reference the same file many times.
struct MemoryBudget {
  std::uint64_t bytes = std::uint64_t{1} << 30;
};

/// Reads a .vtp and charges its memory to `budget`. Reads only the field data arrays named in
/// `fieldData`. Throws Error (input) if the file is damaged, is of another type, declares more than
/// its bytes can hold, or exceeds the budget.
VtkSurface readVtkSurface(const std::filesystem::path& path, const std::set<std::string>& fieldData,
                          MemoryBudget& budget);

} // namespace fenestra::core
