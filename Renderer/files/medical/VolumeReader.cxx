#include "files/medical/VolumeReader.h"

#include "base/Error.h"
#include "files/medical/MedicalImage.h"

namespace fenestra::core {

Volume makeVolume(const std::string& name, const Grid& grid, VoxelStore&& samples) {
  const SampleStats& s = samples.stats();
  if (s.minimum > s.maximum)
    throw inputError(ErrorCode::nonFiniteVoxels, name, "has no finite voxel; write it again");
  Volume volume;
  const auto warn = [&](std::size_t count, const char* what, const char* replacement) {
    if (count > 0)
      volume.warnings.push_back(makeMessage(ErrorCode::nonFiniteVoxels, name, count, " voxels are ",
                                            what, "; they are set to ", replacement));
  };
  warn(s.nanCount, "not a number", "the minimum of the finite values");
  warn(s.infiniteCount, "infinite", "the minimum or maximum of the finite values");
  volume.grid = grid;
  volume.name = name;
  volume.minimum = samples.range()[0];
  volume.maximum = samples.range()[1];
  volume.voxels = samples.take();
  return volume;
}

Volume readVolume(const std::filesystem::path& path, const VolumeChoice& choice) {
  Volume volume;
  const auto consume = [&](const MedicalImage& image, const SampleSource& source) {
    VoxelStore samples(source.count);
    readSamples(source, samples);
    volume = makeVolume(path.string(), image.grid, std::move(samples));
    volume.frameCount = image.frameCount;
    volume.warnings.insert(volume.warnings.begin(), image.warnings.begin(), image.warnings.end());
  };
  readMedicalImage(path, Components::oneFrame, consume, choice);
  return volume;
}

} // namespace fenestra::core
