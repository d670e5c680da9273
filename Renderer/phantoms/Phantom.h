#pragma once
// Synthetic subject: a volume, the structures in it, and display settings.

#include "base/Vector.h"
#include "model/medium/VolumeProperty.h"
#include "model/volume/Volume.h"

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace fenestra::core {

struct PhantomSegment {
  std::string id;   ///< stable, without spaces
  std::string name; ///< display name
  Rgb color;        ///< display-encoded
  std::uint8_t label = 0;
  std::size_t layer = 0; ///< segments of different layers may overlap
};

/// Labels on a box of the volume's voxels; 0: background.
struct PhantomLabels {
  Size3 offset = Size3::Zero();                  ///< first voxel of the box, in the volume
  Size3 size = Size3::Zero();                    ///< voxels
  std::vector<std::vector<std::uint8_t>> layers; ///< x varies fastest
};

struct Phantom {
  Volume volume; ///< int16
  PhantomLabels labels;
  std::vector<PhantomSegment> segments; ///< labels 1, 2, ... in this order in each layer
  VolumeProperty property;              ///< with natural colors
  /// Direction from the subject to a viewpoint with a good view, superior being up; world.
  Vec3 towardViewer = Vec3{-0.35, 1.0, 0.25};
};

/// Receives the finished fraction of the voxels, above 0 to 1. Several threads call it at a time.
using PhantomProgress = std::function<void(double)>;

/// Grid of `size` voxels around `center` (world). `fieldOfView`: mm along the voxel axes; the
/// columns of `axes` are their unit directions in the world. Throws Error (request) unless each
/// axis has 16 to 1024 voxels.
Grid makePhantomGrid(const Size3& size, const Vec3& fieldOfView, const Mat3& axes,
                     const Vec3& center);

} // namespace fenestra::core
