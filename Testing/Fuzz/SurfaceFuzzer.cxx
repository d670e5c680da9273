// Closed-surface segmentations: the first byte selects whether the input is the .vtm, or the .vtp
// of a valid .vtm.
#include "Harness.h"

#include "files/segments/SegmentationReader.h"

FENESTRA_FUZZ(Surface, input) {
  using namespace fenestra::core;
  static const auto validList =
      fuzzing::writeInput("<VTKFile type=\"vtkMultiBlockDataSet\"><vtkMultiBlockDataSet>"
                          "<DataSet index=\"0\" file=\"s.vtp\"/></vtkMultiBlockDataSet></VTKFile>",
                          "valid.vtm");
  const std::string name = fuzzing::chooseName(input, std::array{"s.vtp", "s.vtm"});
  const auto file = fuzzing::writeInput(input, name);
  const Grid reference(Size3(16, 16, 16), Affine::Identity());
  const Segmentation read = readSegmentation(name == "s.vtm" ? file : validList, &reference);
  read.statistics();
}
