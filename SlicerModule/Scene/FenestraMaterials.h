#pragma once
// Changes to the materials of single segments, as values of the option --material.
//
// A change is an argument rather than a rule of a materials file. An argument selects one segment
// by id; rules match patterns of names, codes and label values, which several segments may share.
// Ids need no escaping: no shell reads the arguments, and the renderer takes everything before the
// last colon as the id, including commas, colons and quotes. A file would also have to be written
// for preview and render, saved with the scene, and withheld when an untrusted scene names it.

#include "FenestraSceneFiles.h"

#include <map>
#include <string>
#include <vector>

namespace SlicerExport {

struct MaterialChange {
  std::string segment;                       ///< id; scripts may use a name
  std::map<std::string, std::string> fields; ///< material, color (#rrggbb), clip (yes, no), ...

  /// Value of a field; empty: unchanged.
  std::string field(const std::string& key) const;
  /// Sets a field; an empty value removes it.
  void set(const std::string& key, const std::string& value);
};

/// Parses a text such as "Segment_1: clip=no, color=#963e2e"; no fields if the text has none.
MaterialChange parseMaterialChange(const std::string& text);
std::string toText(const MaterialChange& change);

/// Removes changes to segments not listed, which the renderer would reject; without segments, also
/// removes the flag `materials`.
std::map<std::string, std::string> filterMaterialFlags(const std::vector<Segment>& segments,
                                                       std::map<std::string, std::string> flags);

} // namespace SlicerExport
