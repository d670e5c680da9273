// Volumes; the first byte selects the format. Detached headers can name `samples.raw`; a .hdr has a
// .img beside it. Of several frames, the last is read too, and of two NIfTI forms, both.
#include "Harness.h"

#include "files/medical/NiftiForms.h"
#include "files/medical/VolumeReader.h"

FENESTRA_FUZZ(Volume, input) {
  using namespace fenestra::core;
  static const auto samples = fuzzing::writeInput(std::string(256, '\x2a'), "samples.raw");
  static const auto pair = fuzzing::writeInput(std::string(256, '\x2a'), "v.img");
  const std::string name =
      fuzzing::chooseName(input, std::array{"v.nrrd", "v.nhdr", "v.nii", "v.nii.gz", "v.mha",
                                            "v.mhd", "v.hdr", "v.mgh", "v.mgz"});
  const auto path = fuzzing::writeInput(input, name);
  const Volume volume = readVolume(path);
  if (volume.frameCount > 1)
    readVolume(path, {.frame = volume.frameCount - 1});
  if (readPossibleGrids(path).size() == 2)
    readVolume(path, {.niftiForm = NiftiForm::qform});
}
