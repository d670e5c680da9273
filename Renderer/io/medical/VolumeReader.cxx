#include "io/medical/VolumeReader.h"

#include "io/medical/MedicalImage.h"
#include "io/medical/StoreVoxels.h"

namespace fenestra {

Volume readVolume(const std::filesystem::path& path) {
  MedicalImage image = readMedicalImage(path, Components::one);
  return makeVolume(path.string(), image.grid, std::move(image.samples));
}

} // namespace fenestra
