#pragma once
// Encodes volumes, label maps and slices as NRRD, with the same bytes on every run.

#include "base/Vector.h"

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace fenestra::core {

/// Additional header lines, "key:=value".
using NrrdFields = std::vector<std::pair<std::string, std::string>>;

/// Fields of a NRRD header; the samples follow the header.
struct NrrdHeader {
  enum class Encoding { raw, gzip };

  std::string type;             ///< sample type in NRRD's terms: "short", "float"
  std::string leadingKind = {}; ///< kind of an axis before the spatial axes; empty: no such axis
  std::size_t leadingCount = 1; ///< samples per voxel, along that axis
  Size3 size;                   ///< voxels along each axis, fastest first
  Affine indexToWorld = Affine::Identity(); ///< index to RAS mm; written as LPS
  Encoding encoding = Encoding::gzip;
  NrrdFields fields = {};
};

/// Header lines, including the empty one at the end.
std::string formatNrrdHeader(const NrrdHeader& header);

/// Content of the complete file. `samples`: bytes in memory order, little endian.
std::string encodeNrrd(const NrrdHeader& header, std::string_view samples);

} // namespace fenestra::core
