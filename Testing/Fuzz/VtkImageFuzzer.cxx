// VTK XML images: elements, appended data and blocks.
#include "Harness.h"

#include "files/medical/VolumeReader.h"

FENESTRA_FUZZ(VtkImage, input) {
  fenestra::core::readVolume(fenestra::core::fuzzing::writeInput(input, "v.vti"));
}
