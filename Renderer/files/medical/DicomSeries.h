#pragma once
// Finds the DICOM series in a folder and reads one of them as a volume.

#include "files/medical/VolumeChoice.h"
#include "model/volume/Volume.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace fenestra {

/// Series of slices, one file per slice.
struct DicomSeries {
  std::string uid, number, description, modality; ///< empty: missing
  std::vector<std::filesystem::path> files;       ///< sorted by name
};

/// Finds the image series in a folder, sorted by number, then uid. Searches its direct subfolders
/// only if the folder itself has no files. Skips files that are not DICOM and objects without an
/// image (DICOMDIR, structure sets, plans). Throws Error (input) if there is no series.
std::vector<DicomSeries> findDicomSeries(const std::filesystem::path& folder);

/// Returns the series that `selector` matches by uid, else number, else description; without a
/// selector, the only series. Throws Error (input) that lists the series and mentions --volume if
/// none or several match. `folder` is used in messages.
DicomSeries chooseSeries(const std::vector<DicomSeries>& series,
                         const std::optional<std::string>& selector, const std::string& folder);

/// Reads the slices, sorts them along their normal, and applies rescale slope and intercept. The
/// slice step follows from the positions, so a tilted gantry is handled. Warns if slices deviate
/// from even spacing by more than 2 % of the step. Throws Error (input) that names the file for
/// missing or duplicate slices, deviations over half a step or half a pixel, inconsistent sizes or
/// orientations, multi-frame or color images, missing geometry, and damaged or non-DICOM files.
Volume readDicomVolume(const DicomSeries& series, const VolumeChoice& choice = {});

/// Reads the files that a scene lists. `name` becomes the volume's name and is used in messages.
Volume readDicomVolume(const std::vector<std::filesystem::path>& files, const std::string& name,
                       const VolumeChoice& choice = {});

} // namespace fenestra
