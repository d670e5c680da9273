// Segmentations: metadata, and the mask of the first three segments.
#include "Harness.h"

#include "files/segments/SegmentationReader.h"

FENESTRA_FUZZ(Segmentation, input) {
  using namespace fenestra::core;
  const Segmentation segmentation = readSegmentation(fuzzing::writeInput(input, "s.seg.nrrd"));
  std::vector<std::string> focus;
  for (const SegmentInfo& segment : segmentation.segments())
    if (focus.size() < 3)
      focus.push_back(segment.id);
  const Mask mask = segmentation.makeFocusMask(focus, segmentation.grid());
  if (mask.count < 1 || mask.names.size() != focus.size())
    throw std::logic_error("the mask is empty or incomplete");
}
