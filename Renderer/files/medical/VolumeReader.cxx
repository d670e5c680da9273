#include "files/medical/VolumeReader.h"

#include "files/medical/MedicalImage.h"
#include "files/medical/StoreVoxels.h"

namespace fenestra {

Volume readVolume(const std::filesystem::path& path) {
  Volume volume;
  readMedicalImage(path, Components::one,
                   [&](const MedicalImage& image, const SampleSource& source) {
                     VoxelStore samples(source.count);
                     readSamples(source, samples);
                     volume = makeVolume(path.string(), image.grid, std::move(samples));
                     volume.warnings.insert(volume.warnings.begin(), image.warnings.begin(),
                                            image.warnings.end());
                   });
  return volume;
}

} // namespace fenestra
