#pragma once
// A synthetic subject: an image, what is where in it, and how to show it.

#include "core/Vector.h"
#include "medium/VolumeProperty.h"
#include "volume/Volume.h"

#include <cstdint>
#include <string>
#include <vector>

namespace fenestra {

struct PhantomSegment {
  std::string id;   ///< stable, without spaces
  std::string name; ///< for people
  Rgb color;        ///< display-encoded
  std::uint8_t label = 0;
};

struct Phantom {
  Volume volume;                        ///< int16
  std::vector<std::uint8_t> labels;     ///< on the volume's grid, 0 where there is no segment
  std::vector<PhantomSegment> segments; ///< labels 1, 2, ... in this order
  VolumeProperty property;              ///< shows the volume in natural colours
};

} // namespace fenestra
