#pragma once
// Slicer's tags of a segment. For sources of files alone.

#include "base/TextStream.h"
#include "files/segments/SegmentationReader.h"

#include <string_view>

namespace fenestra {

/// Reads the codes of type and region in
/// "...|TerminologyEntry:LIST~CATEGORY~TYPE~MODIFIER~LIST~REGION~MODIFIER|...", each
/// SCHEME^VALUE^MEANING (vtkSegment, vtkSlicerTerminologiesModuleLogic). Ignores malformed tags.
inline void readTerminology(std::string_view tags, SegmentInfo& info) {
  constexpr std::string_view key = "TerminologyEntry:";
  const std::size_t at = tags.find(key);
  if (at == std::string_view::npos)
    return;
  tags.remove_prefix(at + key.size());
  TextReader entry(std::string(tags.substr(0, tags.find('|'))));
  std::string part;
  for (int i = 0; std::getline(entry, part, '~'); ++i)
    if (const std::size_t meaning = part.rfind('^');
        (i == 2 || i == 5) && meaning != std::string::npos && meaning > 1)
      (i == 2 ? info.type : info.region) = part.substr(0, meaning);
}

} // namespace fenestra
