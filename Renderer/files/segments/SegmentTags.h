#pragma once
// Parts of reading segments. For sources of files alone.

#include "base/Text.h"
#include "files/segments/SegmentationReader.h"

#include <string_view>

namespace fenestra {

/// Labels with a voxel's layers together, from `count` layers one after the other.
Segmentation::Labels interleaved(Segmentation::Labels layers, std::size_t count);

/// Reads the codes of type and region in
/// "...|TerminologyEntry:LIST~CATEGORY~TYPE~MODIFIER~LIST~REGION~MODIFIER|...", each
/// SCHEME^VALUE^MEANING (vtkSegment, vtkSlicerTerminologiesModuleLogic). Ignores malformed tags.
inline void readTerminology(std::string_view tags, SegmentInfo& info) {
  constexpr std::string_view key = "TerminologyEntry:";
  const std::size_t at = tags.find(key);
  if (at == std::string_view::npos)
    return;
  tags.remove_prefix(at + key.size());
  const std::vector<std::string> parts = split(tags.substr(0, tags.find('|')), '~');
  for (const auto& [place, code] : {std::pair(2U, &info.type), {5U, &info.region}})
    if (const std::size_t meaning = place < parts.size() ? parts[place].rfind('^') : 0;
        meaning != std::string::npos && meaning > 1)
      *code = parts[place].substr(0, meaning);
}

} // namespace fenestra
