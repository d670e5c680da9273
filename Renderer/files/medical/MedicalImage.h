#pragma once
// Reads files of the formats of MedicalHeader.h. ITK parses NRRD and MetaImage headers. Raw samples
// and single compressed streams are read by our own code, in one pass. Callers normally use
// VolumeReader.h or SegmentationReader.h.

#include "base/Error.h"
#include "files/medical/SampleSource.h"
#include "files/medical/VolumeChoice.h"
#include "model/volume/Grid.h"

#include <filesystem>
#include <functional>
#include <map>
#include <string>

namespace fenestra::core {

struct MedicalImage {
  Grid grid = {}; ///< index to RAS mm, whatever the space of the file
  std::size_t components = 1;
  std::size_t frameCount = 1; ///< of which one is read
  bool hasFrames = false; ///< components are stored frame by frame; else per voxel; x is fastest
  std::map<std::string, std::string> fields = {}; ///< key:=value pairs of a NRRD
  std::string extensions = {};                    ///< bytes of the NIfTI header extensions
  std::vector<Message> warnings = {};
};

/// How many components per voxel, or frames, a caller can use: one; one frame of several; all.
enum class Components { one, oneFrame, any };

/// Receives the image and a source from which it reads the samples before it returns.
using SampleConsumer = std::function<void(const MedicalImage&, const SampleSource&)>;

/// Calls `consume` once, with an image of three axes and real scalars; further axes of size 1 are
/// dropped. Several components per voxel are read only if `allowed`: a NRRD list, or frames along
/// the fourth axis. Of several frames, the chosen one is read, with a warning if none was chosen.
/// Throws a one-line Error (input) for other images, missing or damaged files, singular geometry, a
/// choice that the file does not offer, and (before memory is allocated) more samples than the file
/// can hold.
void readMedicalImage(const std::filesystem::path& path, Components allowed,
                      const SampleConsumer& consume, const VolumeChoice& choice = {});

} // namespace fenestra::core
