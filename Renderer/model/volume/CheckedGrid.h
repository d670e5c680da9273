#pragma once
// Composed grids: a file's grid under transforms of a scene.

#include "base/Checked.h"
#include "model/volume/Grid.h"

namespace fenestra {

/// Grid of `size` voxels; throws if checkedMap() refuses `indexToWorld`.
inline Grid checkedGrid(const Size3& size, const Affine& indexToWorld, const Complaint& complaint) {
  return {size, checkedMap(indexToWorld, complaint)};
}

} // namespace fenestra
