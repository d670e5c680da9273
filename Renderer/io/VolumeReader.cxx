#include "io/VolumeReader.h"

#include "io/MedicalImage.h"
#include "io/StoreVoxels.h"

namespace fenestra {

Volume readVolume(const std::filesystem::path& path) {
  MedicalImage image = readMedicalImage(path, Components::one);
  return makeVolume(path.string(), image.grid, std::move(image.samples));
}

} // namespace fenestra
