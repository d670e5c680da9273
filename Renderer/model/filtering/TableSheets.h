#pragma once
// Sheets of solid voxels that may be the top of a table, in cells of about 2 mm (ScannerTable.h).

#include "model/masks/Distances.h"

#include <optional>
#include <utility>
#include <vector>

namespace fenestra::core {

inline constexpr double thickestSheet = 14.0; ///< mm
inline constexpr double greatestSag = 6.0;    ///< mm, of a sheet along the patient

/// Voxels above the level. Columns run across the patient, rows toward the table, slices
/// along the patient.
struct SolidVoxels {
  static constexpr double level = -500.0; ///< HU

  bool at(std::int64_t column, std::int64_t row, std::int64_t slice) const {
    return marks[linearIndex({column, row, slice}, size)] != 0;
  }

  Size3 size = Size3::Zero();
  Vec3 spacing = Vec3::Constant(1.0); ///< mm
  Marks marks = {};
};

/// y = a + b x + c x^2, by least squares.
struct Parabola {
  double a = 0.0, b = 0.0, c = 0.0;

  double at(double x) const { return a + x * (b + x * c); }
  /// nullopt: not determined by the points.
  static std::optional<Parabola> fit(const std::vector<std::pair<double, double>>& points);
};

/// The top of a sheet, which lies on a parabola but for its raised edges. Arguments are voxels.
class Sheet {
public:
  /// Row of the sheet in most slices; -1: the column has none, or is in contact with the patient.
  std::int64_t row(std::int64_t column) const;
  /// True if no thick body is near the top of this column, which must have one, in this slice.
  bool isFree(std::int64_t column, std::int64_t slice) const;
  bool isOnParabola(std::int64_t column) const {
    return onParabola[static_cast<std::size_t>(column / factor.x())];
  }
  /// True for columns between those on the parabola.
  bool isBetweenPieces(std::int64_t column) const;

  Size3 factor = Size3::Constant(1); ///< voxels per cell
  Size3 size = Size3::Zero();        ///< cells
  std::vector<std::int64_t> tops;    ///< cells, per column; -1: none
  std::vector<bool> onParabola;
  Marks thick; ///< cells of bodies thicker than a sheet
};

/// False if there can be no sheet, on either side of the patient.
bool mayHaveSheet(const SolidVoxels& solid);

/// The uppermost sheet that can be a table's top; nullopt: none.
std::optional<Sheet> findSheet(const SolidVoxels& solid);

} // namespace fenestra::core
