// Regions of interest (.mrk.json).
#include "Approx.h"
#include "Harness.h"

#include "files/slicer/MrmlScene.h"

FENESTRA_FUZZ(Roi, input) {
  using namespace fenestra::core;
  static const auto scenePath = fuzzing::writeInput(
      "<MRML version=\"Slicer5\" userTags=\"\">"
      "<MarkupsROI id=\"roi\" name=\"R\" references=\"storage:file;\"></MarkupsROI>"
      "<MarkupsROIJsonStorage id=\"file\" name=\"S\" fileName=\"r.mrk.json\">"
      "</MarkupsROIJsonStorage></MRML>",
      "scene.mrml");
  fuzzing::writeInput(input, "r.mrk.json");
  static MrmlScene scene(scenePath);
  const CropBox box = readSceneRoi(scene, *scene.document.find("roi"));
  if (!allFinite(box.worldToBox))
    throw std::logic_error("the box is not finite");
}
