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

/// Fields of a NRRD header; the samples follow the header.
struct NrrdHeader {
  enum class Encoding { raw, gzip };

  std::string type;             ///< sample type in NRRD's words: "short", "float"
  std::string leadingKind = {}; ///< kind of an axis before the spatial axes; empty: no such axis
  std::size_t leadingCount = 1; ///< samples per voxel, along that axis
  Size3 size;                   ///< voxels along each axis, fastest first
  Affine indexToWorld = Affine::Identity(); ///< index to RAS mm; written as LPS
  Encoding encoding = Encoding::gzip;
  NrrdFields fields = {};
};

/// Header lines up to the empty one, inclusive.
std::string formatNrrdHeader(const NrrdHeader& header);

/// Content of the whole file. `samples`: bytes in memory order, little endian.
std::string encodeNrrd(const NrrdHeader& header, std::string_view samples);

} // namespace fenestra
