#pragma once
// Border of the focus: what the volume holds to both sides of the faces between its voxels and
// others.

#include "model/medium/LabelWeights.h"
#include "model/medium/TransferFunction.h"
#include "model/volume/Mask.h"
#include "model/volume/Volume.h"

#include <vector>

namespace fenestra {

/// Scalars at the focus's border: of the three voxels to either side of its labels' faces, those
/// that the transfer function shows; at most some ten thousand of each.
struct InterfaceScalars {
  std::vector<double> focus, context;
};

/// `focus`: of at least one voxel. A side that is transparent has none.
InterfaceScalars sampleInterface(const Mask& focus, const Volume& volume,
                                 const TransferFunction& transfer);

/// Part of the border, where two components of the medium meet, as far as both are shown.
struct ComponentInterface {
  std::uint8_t focus, context;
  double area;                       ///< of the voxels' faces, mm^2, but for a common factor
  double focusScalar, contextScalar; ///< medians of the three voxels to either side
};

/// Parts of the border, the largest first. `isFocus`: by component; a voxel's component is, of its
/// side's, the one with the greatest share.
std::vector<ComponentInterface> findInterfaces(const Mask& focus, const Volume& volume,
                                               const TransferFunction& transfer,
                                               const LabelWeights& weights,
                                               const std::vector<bool>& isFocus);

} // namespace fenestra
