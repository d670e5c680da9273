#pragma once
// Non-local means: each voxel becomes a mean of voxels around it, weighted by how similar their
// surroundings are (Buades, Coll, Morel 2005). Noise falls, edges stay.

#include "base/StopFlag.h"
#include "model/volume/Volume.h"

namespace fenestra::core {

struct NonLocalMeans {
  double noise;    ///< standard deviation s, scalar units
  double strength; ///< h, scalar units: patches that differ by more than h count little
  bool isLogarithmic =
      false; ///< compares log(1 + scalar - minimum); both members are on that scale
};

/// u'(x) = sum of w(x, y) u(y) / sum of w(x, y), with w = exp(-t), as the compact (1 - t/16)^16,
/// and t = max(0, d^2 - 2 s^2) / h^2. d^2 is the mean squared difference of the patches of 3x3x3
/// voxels around x and y; 2 s^2 of it is noise. The voxel itself weighs as much as the greatest
/// other, at least 1/1000. y is within a ball of 47 voxels' volume, at most 3 voxels away on each
/// axis; neighbors on the axes always count. Beyond the volume, its border voxels repeat. Keeps the
/// voxel type (integers are rounded) and stays within the volume's range. Results do not depend on
/// threads or instruction set. A strength below 10^-12 of the range changes nothing. The result is
/// incomplete if `stop` was set meanwhile.
Volume applyNonLocalMeans(const Volume& volume, const NonLocalMeans& filter,
                          const StopFlag& stop = neverStopped);

/// Copy of a volume without its voxels and their range.
Volume copyWithoutVoxels(const Volume& volume);

} // namespace fenestra::core
