#pragma once
// A grid that is composed: a file's under transforms of a scene.

#include "base/Checked.h"
#include "model/volume/Grid.h"

namespace fenestra {

/// The grid, where its map passes checkedMap; throws otherwise.
inline Grid checkedGrid(const Size3& size, const Affine& indexToWorld, const Complaint& complaint) {
  return {size, checkedMap(indexToWorld, complaint)};
}

} // namespace fenestra
