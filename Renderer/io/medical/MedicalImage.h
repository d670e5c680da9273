#pragma once
// Reads NRRD, NIfTI and MetaImage files through ITK, in their own sample type. For io's own
// sources: VolumeReader.h and SegmentationReader.h make of it what a scene needs.

#include "volume/Grid.h"

#include <filesystem>
#include <map>
#include <string>
#include <variant>
#include <vector>

namespace fenestra {

using Samples =
    std::variant<std::vector<std::int8_t>, std::vector<std::uint8_t>, std::vector<std::int16_t>,
                 std::vector<std::uint16_t>, std::vector<std::int32_t>, std::vector<std::uint32_t>,
                 std::vector<std::int64_t>, std::vector<std::uint64_t>, std::vector<float>,
                 std::vector<double>>;

struct MedicalImage {
  Grid grid = {}; ///< to RAS, whatever the file says
  std::size_t components = 1;
  Samples samples = {};                           ///< components of a voxel together, x fastest
  std::map<std::string, std::string> fields = {}; ///< NRRD's key:=value pairs
};

enum class Components { one, any };

/// Exactly three axes (further ones of size 1 are dropped), real scalars; several of them in a
/// voxel only where `allowed`: a NRRD's list, or the frames along its fourth axis. Throws Error
/// (input), one line, for anything else: missing or damaged files, more samples than the file can
/// hold (before memory is taken for them), geometry that no point can be mapped through.
MedicalImage readMedicalImage(const std::filesystem::path& path, Components allowed);

} // namespace fenestra
