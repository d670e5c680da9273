#pragma once
// Volumes and label maps as NRRD, byte for byte the same on every run.

#include "volume/Grid.h"

#include <filesystem>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace fenestra {

/// Further lines of the header, "key:=value".
using NrrdFields = std::vector<std::pair<std::string, std::string>>;

/// Writes `layers`, each with a value for every voxel of `grid`, x fastest: one layer as a
/// three-dimensional volume, several as a list axis in front of three domain axes, as Slicer writes
/// overlapping segments. LPS, gzip, little endian; the file appears whole or not at all. Throws
/// Error (output).
template <typename Value>
void writeNrrd(const std::filesystem::path& path, const Grid& grid,
               const std::vector<std::span<const Value>>& layers, const NrrdFields& fields = {});

extern template void writeNrrd(const std::filesystem::path&, const Grid&,
                               const std::vector<std::span<const std::uint8_t>>&,
                               const NrrdFields&);
extern template void writeNrrd(const std::filesystem::path&, const Grid&,
                               const std::vector<std::span<const std::int16_t>>&,
                               const NrrdFields&);

} // namespace fenestra
