#pragma once
// Volumes, label maps and slices as NRRD, byte for byte the same on every run.

#include "base/Vector.h"

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace fenestra {

/// Further lines of the header, "key:=value".
using NrrdFields = std::vector<std::pair<std::string, std::string>>;

/// What a NRRD says of its samples, which follow it.
struct NrrdHeader {
  enum class Encoding { raw, gzip };

  std::string type;             ///< of a sample, as NRRD names it: "short", "float"
  std::string leadingKind = {}; ///< of an axis before those of space; empty: there is none
  std::size_t leadingCount = 1; ///< samples a voxel, along that axis
  Size3 size;                   ///< voxels in each axis, the fastest first
  Affine indexToWorld = Affine::Identity(); ///< index to RAS mm; written as LPS
  Encoding encoding = Encoding::gzip;
  NrrdFields fields = {};
};

/// The lines up to the empty one, with it.
std::string nrrdText(const NrrdHeader& header);

/// The whole file. `samples`: as they lie in memory, little endian.
std::string encodeNrrd(const NrrdHeader& header, std::string_view samples);

} // namespace fenestra
