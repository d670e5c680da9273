#pragma once
// DICOM series: which there are in a folder, and one of them as a volume.

#include "model/volume/Volume.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace fenestra {

/// One file a slice.
struct DicomSeries {
  std::string uid, number, description, modality; ///< what is missing is empty
  std::vector<std::filesystem::path> files;       ///< sorted by name
};

/// The series of images in the folder itself (in the folders below only where it holds no file at
/// all), sorted by number, then uid. Files that are not DICOM, and objects without an image
/// (DICOMDIR, structures, plans), are passed over. Throws Error (input) where there is no series.
std::vector<DicomSeries> findDicomSeries(const std::filesystem::path& folder);

/// The only one, or the one that `selector` names by uid, else number, else description. Throws
/// Error (input), listing them and naming --volume, where that is none or several. `folder` is for
/// messages.
const DicomSeries& chooseSeries(const std::vector<DicomSeries>& series,
                                const std::optional<std::string>& selector,
                                const std::string& folder);

/// The slices sorted by their positions along their normal, with rescale slope and intercept
/// applied; the step between slices is that of their positions, so that a tilted gantry is right as
/// well. Slices off their even places by more than 2 % of the step are warned of. Throws Error
/// (input), naming the file, where slices are missing or repeated, any is more than half a step or
/// half a pixel off, sizes or orientations differ, a file holds several frames or colours, lacks
/// its geometry, or is damaged or not DICOM.
Volume readDicomVolume(const DicomSeries& series);

/// The same of a list of files, as a scene names them; `name` is the volume's, for messages.
Volume readDicomVolume(const std::vector<std::filesystem::path>& files, const std::string& name);

} // namespace fenestra
