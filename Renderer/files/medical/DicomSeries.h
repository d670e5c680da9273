#pragma once
// DICOM series: those in a folder, and a volume from a series.

#include "model/volume/Volume.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace fenestra {

/// Series of slices, one file each.
struct DicomSeries {
  std::string uid, number, description, modality; ///< empty: missing
  std::vector<std::filesystem::path> files;       ///< sorted by name
};

/// Series of images in the folder itself (in the folders below only if it holds no file), sorted by
/// number, then uid. Skips files that are not DICOM, and objects without an image (DICOMDIR,
/// structures, plans). Throws Error (input) where there is no series.
std::vector<DicomSeries> findDicomSeries(const std::filesystem::path& folder);

/// Series that `selector` names by uid, else number, else description; without a selector the only
/// series. Throws Error (input), listing the series and naming --volume, where none or several
/// match. `folder` is for messages.
DicomSeries chooseSeries(const std::vector<DicomSeries>& series,
                         const std::optional<std::string>& selector, const std::string& folder);

/// Volume of the slices, sorted along their normal, with rescale slope and intercept applied. The
/// step between slices is that of their positions, so that a tilted gantry is right as well. Warns
/// of slices more than 2 % of the step off even places. Throws Error (input), naming the file, for
/// missing or repeated slices, slices more than half a step or half a pixel off, different sizes or
/// orientations, several frames or colours, missing geometry, and files that are damaged or not
/// DICOM.
Volume readDicomVolume(const DicomSeries& series);

/// Volume of a scene's list of files; `name`: the volume's, for messages.
Volume readDicomVolume(const std::vector<std::filesystem::path>& files, const std::string& name);

} // namespace fenestra
