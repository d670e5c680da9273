#pragma once
// One surface of a VTK XML file (.vtp), as Slicer writes it: data inline, as text or base64, plain
// or deflated. VTK is not used, since it trusts the sizes that a file declares.

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
  std::vector<Vec3> points;                            ///< points in the file's space
  std::vector<std::array<std::uint32_t, 3>> triangles; ///< triangles of polygons and strips
  bool hasLines = false;
  std::map<std::string, std::string> texts;           ///< field data: the first of each array
  std::map<std::string, std::vector<double>> numbers; ///< field data
};

/// Bytes that the texts and numbers of files that belong together may still take: deflated arrays
/// grow a thousandfold, and one file may be named often.
struct MemoryBudget {
  std::uint64_t bytes = std::uint64_t{1} << 30;
};

/// Reads a .vtp, of its field data only the arrays named `fieldData`, and deducts its memory from
/// `allowance`. Throws Error (input) where the file is damaged, of another type, declares more than
/// its bytes can hold, or exceeds the allowance.
VtkSurface readVtkSurface(const std::filesystem::path& path, const std::set<std::string>& fieldData,
                          MemoryBudget& budget);

} // namespace fenestra
