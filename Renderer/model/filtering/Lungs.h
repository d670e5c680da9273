#pragma once
// Finds the lungs in a chest CT without labels: large spaces of the density of lungs that no air
// connects with the sides of the scan. Vessels and bronchi inside belong to them.

#include "model/masks/Distances.h"
#include "model/volume/Volume.h"

#include <optional>

namespace fenestra::core {

struct Lungs {
  Grid grid = {};      ///< cells of about 1.5 mm, each of whole voxels
  Marks marks = {};    ///< 1: lung
  double volume = 0.0; ///< mm^3
};

/// nullopt: none. Lungs are connected cells below -400 HU, 150 ml or more, with a median above
/// -950 HU, which the gas in bowels does not reach. They are closed by 6 mm, which fills vessels.
/// The trachea belongs to them. Lungs that are open to the side of a scan, because it shows only a
/// part of the chest, are not found.
std::optional<Lungs> findLungs(const Volume& ct);

} // namespace fenestra::core
