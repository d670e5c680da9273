#pragma once
// Reads NRRD, NIfTI and MetaImage files: what their headers mean through ITK, their samples by our
// own code where they are raw or one stream, in one pass. For io's own sources: VolumeReader.h and
// SegmentationReader.h make of it what a scene needs.

#include "files/medical/SampleSource.h"
#include "model/volume/Grid.h"

#include <filesystem>
#include <functional>
#include <map>
#include <string>

namespace fenestra {

struct MedicalImage {
  Grid grid = {}; ///< to RAS, whatever the file says
  std::size_t components = 1;
  bool frames = false; ///< components lie one whole frame after the other, else those of a voxel
                       ///< together; x fastest
  std::map<std::string, std::string> fields = {}; ///< NRRD's key:=value pairs
  std::vector<std::string> warnings = {};         ///< each names the file
};

enum class Components { one, any };

/// What is made of the samples, which are read only now.
using TakeSamples = std::function<void(const MedicalImage&, const SampleSource&)>;

/// Exactly three axes (further ones of size 1 are dropped), real scalars; several of them in a
/// voxel only where `allowed`: a NRRD's list, or the frames along its fourth axis. Calls `take`
/// once. Throws Error (input), one line, for anything else: missing or damaged files, more samples
/// than the file can hold (before memory is taken for them), geometry that no point can be mapped
/// through.
void readMedicalImage(const std::filesystem::path& path, Components allowed,
                      const TakeSamples& take);

} // namespace fenestra
