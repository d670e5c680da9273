#pragma once
// Reads NRRD, NIfTI and MetaImage files: headers through ITK, but for NIfTI's; samples by our own
// code, in one pass, where they are raw or one stream. Scenes use VolumeReader.h and
// SegmentationReader.h.

#include "files/medical/SampleSource.h"
#include "model/volume/Grid.h"

#include <filesystem>
#include <functional>
#include <map>
#include <string>

namespace fenestra {

struct MedicalImage {
  Grid grid = {}; ///< index to RAS mm, whatever the file's space
  std::size_t components = 1;
  bool hasFrames = false; ///< components: one frame after the other; else by voxel; x fastest
  std::map<std::string, std::string> fields = {}; ///< NRRD's key:=value pairs
  std::string extensions = {};                    ///< bytes of NIfTI's header extensions
  std::vector<std::string> warnings = {};         ///< each names the file
};

enum class Components { one, any };

/// Consumer of the samples, which are read while it runs.
using SampleConsumer = std::function<void(const MedicalImage&, const SampleSource&)>;

/// Calls `take` once, with an image of three axes (further ones of size 1 are dropped) and real
/// scalars; several per voxel only where `allowed`: a NRRD's list, or the frames along its fourth
/// axis. Throws Error (input), one line, for other images, missing or damaged files, more samples
/// than the file can hold (before memory is taken for them), and singular geometry.
void readMedicalImage(const std::filesystem::path& path, Components allowed,
                      const SampleConsumer& consume);

} // namespace fenestra
