#pragma once
// Checks of composed maps (transforms above a node, a box or a grid under transforms), whatever
// their source. Single numbers are checked where they are read.

#include "base/Error.h"
#include "base/Vector.h"

#include <functional>
#include <string>

namespace fenestra {

/// Makes an Error from a description: adds the file and the field, or the flag.
using MakeError = std::function<Error(const std::string& what)>;

/// Returns `map` if invertible with digits to spare: lengths of columns in (1e-9, 1e9),
/// |translation| < 1e9 mm in each axis, |determinant| of the normalised columns > 1e-6. Throws
/// otherwise: beyond these bounds a point keeps no fraction of a voxel.
inline Affine checkAffine(const Affine& map, const MakeError& makeError) {
  constexpr double maxScale = 1e9, minDeterminant = 1e-6;
  const auto lengths = map.linear().columnNorms().array();
  if (!((lengths > 1.0 / maxScale).all() && (lengths < maxScale).all() &&
        (map.translation().array().abs() < maxScale).all() &&
        std::abs(map.linear().normalizedColumns().determinant()) > minDeterminant))
    throw makeError("cannot be inverted within scales of 1e-9 to 1e9 and places of 1e9 mm");
  return map;
}

} // namespace fenestra
