#pragma once
// Minimal valid files that a scene can reference, one per kind.

#include "Harness.h"

#include <map>
#include <string>

namespace fenestra::core::fuzzing {

/// Contents by file name.
inline std::map<std::string, std::string> sceneFixtures() {
  const std::string nrrd = "NRRD0004\ntype: uint8\ndimension: 3\nspace: left-posterior-superior\n"
                           "sizes: 2 2 2\nspace directions: (1,0,0) (0,1,0) (0,0,1)\n"
                           "encoding: raw\nspace origin: (0,0,0)\n";
  return {
      {"v.nrrd", nrrd + "\nabcdefgh"},
      {"s.seg.nrrd", nrrd + "Segment0_ID:=A\nSegment0_LabelValue:=1\n\n" + std::string(8, '\1')},
      {"p.vp", "1\n1\n0.2\n0.9\n0.3\n20\n4 0 0 120 0.8\n4 0 1 255 1\n8 0 0 0 0 120 1 1 1\n"},
      {"p.vp.json",
       R"({"volumeProperties":[{"components":[{"rgbTransferFunction":{"points":[{"x":0,)"
       R"("color":[1,1,1]}]},"scalarOpacity":{"points":[{"x":0,"y":0.5}]}}]}]})"},
      {"r.mrk.json",
       R"({"markups":[{"type":"ROI","coordinateSystem":"LPS","roiType":"Box","center":[0,0,0],)"
       R"("orientation":[-1,0,0,0,-1,0,0,0,1],"size":[1,2,3]}]})"},
      {"t.tfm", "#Insight Transform File V1.0\n#Transform 0\nTransform: "
                "AffineTransform_double_3_3\nParameters: 1 0 0 0 1 0 0 0 1 5 -3 2\n"
                "FixedParameters: 0 0 0\n"},
  };
}

/// Writes the files to folder() at the first call.
inline void writeSceneFixtures() {
  static const bool written = [] {
    for (const auto& [name, content] : sceneFixtures())
      writeInput(content, name);
    return true;
  }();
  static_cast<void>(written);
}

} // namespace fenestra::core::fuzzing
