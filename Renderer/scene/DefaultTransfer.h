#pragma once
// The transfer function of a volume for which none is named: a built-in preset, chosen by modality,
// contrast agent and what is segmented, else one that follows the volume's range.

#include "files/appearance/TransferReader.h"
#include "model/volume/Volume.h"
#include "scene/Input.h"

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace fenestra::core {

/// Scalars of no tissue (0), cerebrospinal fluid (1), gray matter (2) and white matter (3): what
/// 0 to 3 stand for in a transfer function with "scalars": "tissues".
using TissueScale = std::array<double, 4>;

/// What the segments say about a scan.
struct ScanContent {
  bool hasSegments = false;
  bool isLungFocus = false;         ///< all segments of the focus are of the lungs
  std::optional<double> blood = {}; ///< value of blood in the aorta or the heart
  bool isKnee = false;              ///< of MR: parts of a knee are segmented
  std::vector<double> brain = {};   ///< values in the brain; empty: not segmented
};

/// Reads the values of blood and brain under the segments of a volume. Blood is the greatest median
/// of the segments of aorta and heart, since a false lumen may be without contrast agent.
/// `hasVoxels`: per segment. `focus`: ids, names or label values. Throws Error (input) for one that
/// does not exist.
ScanContent describeScan(const Volume& volume, const Segmentation& segmentation,
                         const std::vector<bool>& hasVoxels, const std::vector<std::string>& focus);

/// Name of the default preset; empty: makeRelativeTransfer().
/// CT: ct-skin without segments, ct-lung for the lungs, ct-contrast if the file states a contrast
/// agent or blood is above 130 HU (without agent it is below 90), else ct-anatomy. MR: mr-knee for
/// a knee, else mr-anatomy; also if the file states no modality and a tenth of the values are air.
/// Ultrasound: us-fetal. PET in SUV: pet.
std::optional<std::string> chooseTransferPreset(const Volume& volume, const ScanContent& content);

/// Function for the volume's scalars; relative scalars are mapped to its robust range or to
/// findTissues().
TransferFunction fitToVolume(const TransferFile& transfer, const Volume& volume,
                             const ScanContent& content);

/// Scale of the tissues of a head in MR: the centers of three classes (Lloyd's algorithm, 1982) of
/// the values in `brain`, or without any, of all that are above the lowest 6 % of the robust range.
/// Tissues have no fixed values in MR, and percentiles depend on how much of the scan is air, scalp
/// or fluid. Evenly spaced if the volume has fewer than three values.
TissueScale findTissues(const Volume& volume, const std::vector<double>& brain);

/// Transfer function for volumes without an absolute scale (MR, ultrasound, stored values). The
/// opacity rises from transparent at the background level to opaque at the 99.5th percentile.
/// Extinction is relative to the size of the volume. A constant volume becomes a thin uniform
/// medium without shading.
TransferFunction makeRelativeTransfer(const Volume& volume);

} // namespace fenestra::core
