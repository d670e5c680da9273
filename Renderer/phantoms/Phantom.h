#pragma once
// A synthetic subject: an image, what is where in it, and how to show it.

#include "base/Vector.h"
#include "model/medium/VolumeProperty.h"
#include "model/volume/Volume.h"

#include <cstdint>
#include <string>
#include <vector>

namespace fenestra {

struct PhantomSegment {
  std::string id;   ///< stable, without spaces
  std::string name; ///< for people
  Rgb color;        ///< display-encoded
  std::uint8_t label = 0;
  std::size_t layer = 0; ///< segments of different layers may overlap
};

/// Labels on a box of the volume's voxels; 0 where there is no segment.
struct PhantomLabels {
  Size3 offset = Size3::Zero();                  ///< the volume's voxel that the box begins at
  Size3 size = Size3::Zero();                    ///< voxels
  std::vector<std::vector<std::uint8_t>> layers; ///< x fastest
};

struct Phantom {
  Volume volume; ///< int16
  PhantomLabels labels;
  std::vector<PhantomSegment> segments; ///< labels 1, 2, ... in this order within a layer
  VolumeProperty property;              ///< shows the volume in natural colours
  /// World, from the subject to a viewer who sees it well, with superior up.
  Vec3 towardViewer = Vec3{-0.35, 1.0, 0.25};
};

/// Throws Error (usage) unless each axis has 16 to 1024 voxels.
void requirePhantomSize(const Size3& size);

/// `fieldOfView` mm along voxel axes whose unit directions in the world are the columns of `axes`,
/// in `size` voxels around `center` (world).
Grid phantomGrid(const Size3& size, const Vec3& fieldOfView, const Mat3& axes, const Vec3& center);

} // namespace fenestra
