#pragma once
// Changes to the materials of single segments, as values of the flag --material.
//
// A change is an argument, not a rule of a file of materials: an argument selects one segment by
// its id, while the rules of a file match by patterns of names, codes and label values, of which
// several segments may share one. Nothing in an id needs an escape: no shell reads the arguments,
// and the renderer takes what stands before the last colon for the id, whatever commas, colons and
// quotes it has. And there is no file that would have to be written for preview and render, saved
// with the scene, and withheld when somebody else's scene names it.

#include "FenestraSceneFiles.h"

#include <map>
#include <string>
#include <vector>

namespace SlicerExport {

struct MaterialChange {
  std::string segment;                       ///< id; a script's may be a name
  std::map<std::string, std::string> fields; ///< material, color (#rrggbb), clip (yes, no), ...

  /// Value of a field; empty: not changed.
  std::string field(const std::string& key) const;
  /// Sets a field; empty: takes the change back.
  void set(const std::string& key, const std::string& value);
};

/// Change in a text such as "Segment_1: clip=no, color=#963e2e"; without fields if it has none.
MaterialChange parseMaterialChange(const std::string& text);
std::string toText(const MaterialChange& change);

/// Flags without changes to other segments than these, which the renderer would refuse; without
/// segments, there are no materials.
std::map<std::string, std::string> filterMaterialFlags(const std::vector<Segment>& segments,
                                                       std::map<std::string, std::string> flags);

} // namespace SlicerExport
