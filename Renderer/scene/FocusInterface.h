#pragma once
// Interface between the focus and its surroundings: the scalars of the volume on both sides of the
// faces between focus voxels and other voxels.

#include "model/medium/LabelWeights.h"
#include "model/medium/TransferFunction.h"
#include "model/volume/Mask.h"
#include "model/volume/Volume.h"

#include <vector>

namespace fenestra::core {

/// Scalars of the three voxels on either side of each face, without those that the transfer
/// function makes transparent. Subsampled to about ten thousand per side.
struct InterfaceScalars {
  std::vector<double> focus, context;
};

/// `focus`: has at least one voxel. The result of a transparent side is empty.
InterfaceScalars sampleInterface(const Mask& focus, const Volume& volume,
                                 const TransferFunction& transfer);

/// Part of the interface where two given components of the medium meet and both are visible.
struct ComponentInterface {
  std::uint8_t focus, context;
  double area;                       ///< of the voxel faces, proportional to mm²
  double focusScalar, contextScalar; ///< medians over the three voxels on either side
};

/// Returns the parts of the interface, largest first. `isFocus`: per component. The component of a
/// voxel is the one with the largest label weight among those of its side.
std::vector<ComponentInterface> findInterfaces(const Mask& focus, const Volume& volume,
                                               const TransferFunction& transfer,
                                               const LabelWeights& weights,
                                               const std::vector<bool>& isFocus);

} // namespace fenestra::core
