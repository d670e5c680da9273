#include "files/medical/StoreVoxels.h"

#include "base/Error.h"

#include <utility>

namespace fenestra {
namespace {

void warn(const SampleSurvey& s, Volume& volume) {
  const auto line = [&volume](std::size_t count, const char* what, const char* replacement) {
    if (count > 0)
      volume.warnings.push_back(volume.name + ": " + std::to_string(count) + " voxels are " + what +
                                " and count as " + replacement);
  };
  line(s.notANumber, "not a number", "the least finite value");
  line(s.infinite, "infinite", "the least or greatest finite value");
}

} // namespace

Volume makeVolume(std::string name, const Grid& grid, VoxelStore&& samples) {
  Volume volume;
  volume.grid = grid;
  volume.name = std::move(name);
  const SampleSurvey& s = samples.survey();
  if (s.least > s.greatest)
    throw inputError(volume.name, "no voxel is a finite number; write it again");
  warn(s, volume);
  volume.minimum = samples.range()[0];
  volume.maximum = samples.range()[1];
  volume.voxels = samples.take();
  return volume;
}

} // namespace fenestra
