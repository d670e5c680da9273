#pragma once
// Finds the table on which a patient lies in a CT. A table has the same cross-section in all slices
// and is a thin sheet with air above it, wider than fingers and ears; nothing of the patient is
// below its top.

#include "model/volume/Mask.h"
#include "model/volume/Volume.h"

#include <optional>
#include <vector>

namespace fenestra::core {

/// Axes of a grid that are nearest to those of the patient.
struct PatientAxes {
  int across, down, along; ///< right-left, anterior-posterior, inferior-superior
};

/// Top of a table. Rows count in the direction of the table, from the volume's other side.
struct ScannerTable {
  PatientAxes axes = {};
  bool isDownPositive = true; ///< rows are indices along `down`; else they count from the last one
  std::vector<std::int64_t> tops;    ///< first row of the table, per column; -1: outside of it
  std::vector<std::int64_t> offsets; ///< to be added in each slice, where the table sags
};

/// nullopt: no table was found with certainty. Its sheet consists of voxels above -500 HU, thinner
/// than 14 mm in at least half of the slices, in pieces of 30 mm and 100 mm in all that lie on one
/// parabola, which states the top where the patient lies on the sheet; what is below the sheet goes
/// with it. Where the parabola does not fit within a voxel, or the sheet's lower side is not
/// parallel to it, contact with the patient is uncertain, and the sheet remains there. Uncertain is
/// a table if more than 0.1 % of the thicker bodies above its top reaches below it. Axes must
/// be within 20 degrees of the patient's, and the volume at least 30 mm long.
std::optional<ScannerTable> findScannerTable(const Volume& ct);

/// Sets what is below the table's top, a voxel above -500 HU on it with air above, and within two
/// voxels what is not above -500 HU, to -1000 HU, or to the volume's minimum if that is greater,
/// but for voxels whose centers are in `preserved` (null: none). Returns the volume of what was
/// above -500 HU, mm^3.
double removeScannerTable(const ScannerTable& table, const Mask* preserved, Volume& ct);

} // namespace fenestra::core
