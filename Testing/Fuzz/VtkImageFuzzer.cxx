// VTK XML images: elements, appended data and blocks.
#include "Harness.h"

#include "files/medical/VolumeReader.h"

FENESTRA_FUZZ(VtkImage, input) {
  fenestra::readVolume(fenestra::fuzzing::writeInput(input, "v.vti"));
}
