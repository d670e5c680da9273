// Volumes; the first byte selects the format. Detached headers can name `samples.raw`.
#include "Harness.h"

#include "files/medical/VolumeReader.h"

FENESTRA_FUZZ(Volume, input) {
  using namespace fenestra;
  static const auto samples = fuzzing::writeInput(std::string(256, '\x2a'), "samples.raw");
  const std::string name = fuzzing::chooseName(
      input, std::array{"v.nrrd", "v.nhdr", "v.nii", "v.nii.gz", "v.mha", "v.mhd"});
  readVolume(fuzzing::writeInput(input, name));
}
