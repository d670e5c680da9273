#pragma once
// Validates composed maps (products of transforms, a box or grid under transforms) once, after
// composition. Single numbers are validated where they are read.

#include "base/Error.h"
#include "base/Vector.h"

#include <functional>
#include <string>

namespace fenestra::core {

/// Makes an Error from a description, adding the file and field, or the option.
using MakeError = std::function<Error(const std::string& what)>;

/// Returns `map` if it can be inverted accurately: column lengths in (1e-9, 1e9), |translation| <
/// 1e9 mm per axis, |determinant| of the normalized columns > 1e-6. Throws otherwise: beyond these
/// bounds rounding errors reach the size of a voxel.
inline Affine checkAffine(const Affine& map, const MakeError& makeError) {
  constexpr double maxScale = 1e9, minDeterminant = 1e-6;
  const auto lengths = map.linear().columnNorms().array();
  if (!((lengths > 1.0 / maxScale).all() && (lengths < maxScale).all() &&
        (map.translation().array().abs() < maxScale).all() &&
        std::abs(map.linear().normalizedColumns().determinant()) > minDeterminant))
    throw makeError("must be invertible, with scales 1e-9 to 1e9 and translations below 1e9 mm");
  return map;
}

} // namespace fenestra::core
