#pragma once
// Finds the volumes of the DICOM files in a folder and reads one of them.
//
// Everything works on slices: files of one image, and frames of multi-frame files. Slices with the
// same SeriesInstanceUID are a series (without one: those that agree in frame of reference, size,
// orientation, number, description and modality). DicomSplit.cxx states which slices of a series
// are left out, and how the others become several volumes, and these become frames over time.

#include "files/medical/DicomReader.h"
#include "files/medical/VolumeChoice.h"
#include "model/volume/Volume.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace fenestra::core {

struct DicomSlice {
  std::filesystem::path path;
  DicomHeader header;
};
using DicomSlices = std::vector<DicomSlice>;

/// Center of the first voxel, LPS mm; the header must have it.
inline Vec3 getPosition(const DicomSlice& slice) {
  const std::vector<double>& p = slice.header.position;
  return {p[0], p[1], p[2]};
}

/// Series, or one of its volumes.
struct DicomSeries {
  std::string uid, number, description, modality; ///< empty: missing
  /// What distinguishes it from the other volumes of the series, like "echo 4.9 ms"; empty: nothing
  std::string part = {};
  std::vector<DicomSlices> frames = {}; ///< at least one; over time
  std::vector<Message> warnings = {};   ///< about slices that are left out
  bool isVolume = true; ///< false: reading it will fail, since it is not gray or has no geometry

  /// Without repetitions, in the order of the slices.
  std::vector<std::filesystem::path> files() const;
  /// Name by which chooseSeries finds it: number and part, if it has them.
  std::string name() const;
};

/// SEG or RTSTRUCT file.
struct DicomSegmentationFile {
  std::filesystem::path path;
  DicomHeader header;
};

struct DicomFolder {
  std::vector<DicomSeries> series; ///< sorted by number, then uid
  std::vector<DicomSegmentationFile> segmentations;

  /// Segmentations that refer to the series, or if they refer to none, to its frame of reference.
  std::vector<std::filesystem::path> segmentationsOf(const DicomSeries& series) const;
};

/// Finds the image series in a folder and in its subfolders, up to 16 levels down; links that lead
/// back are followed once. Skips files that are not DICOM, and objects without a scan (DICOMDIR,
/// segmentations, reports, doses), and, with a warning, files of unsupported transfer syntaxes
/// unless there are no others; series that cannot be volumes only count if there are no others.
/// Registers all files as inputs. Throws Error (input) if there is no series, or more than 200 000
/// files.
DicomFolder findDicomSeries(const std::filesystem::path& folder);

/// Finds the series in a folder to which one DICOM file belongs. A multi-frame file is a series of
/// its own; a DICOMDIR stands for its folder. Adds a warning that other files of the folder are
/// read, too.
DicomFolder findSeriesOfFile(const std::filesystem::path& file);

/// Divides slices of one series into its volumes. `name` is used in messages.
std::vector<DicomSeries> splitSeries(DicomSlices slices, const std::string& name);

/// Returns the series that `selector` matches by uid, number, description, part or name. Without a
/// selector: the only series, or the only one of several slices, with a warning. Throws Error
/// (input) that lists the series if none or several match. `folder` is used in messages.
DicomSeries chooseSeries(const std::vector<DicomSeries>& series,
                         const std::optional<std::string>& selector, const std::string& folder);

/// Reads the slices of a frame, sorts them along their normal, and applies rescale slope and
/// intercept. The slice step follows from the positions, so a tilted gantry is handled. Warns if
/// slices deviate from even spacing by more than 2 % of the step. Beyond half a step, as at missing
/// slices, the volume is interpolated linearly at the smallest distance of two slices, with a
/// warning (DicomSpacing.h). Throws Error (input) that names the file for several slices at one
/// position, deviations over half a pixel sideways, gaps too large to fill, color images, missing
/// geometry, and damaged or non-DICOM files.
Volume readDicomVolume(const DicomSeries& series, const VolumeChoice& choice = {});

/// Reads the files that a scene lists. `name` becomes the volume's name and is used in messages.
Volume readDicomVolume(const std::vector<std::filesystem::path>& files, const std::string& name,
                       const VolumeChoice& choice = {});

} // namespace fenestra::core
