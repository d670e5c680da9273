#pragma once
// Numbers of one's own are checked where they are read; what is composed of them (transforms above
// a node, a box or a grid under them) once more, here, wherever they came from.

#include "base/Error.h"
#include "base/Vector.h"

#include <functional>
#include <string>

namespace fenestra {

/// Makes the Error of what is wrong: adds the file and the field, or the flag.
using Complaint = std::function<Error(const std::string& what)>;

/// The map, where it can be inverted with digits to spare, whatever its scale: columns from 1e-9 to
/// 1e9 long, a translation within 1e9 mm, and unit columns that span more than a millionth of a
/// cube. Beyond, a point keeps no fraction of a voxel. Throws otherwise.
inline Affine checkedMap(const Affine& map, const Complaint& complaint) {
  constexpr double largest = 1e9, flattest = 1e-6;
  const auto scales = map.linear().columnNorms().array();
  if (!((scales > 1.0 / largest).all() && (scales < largest).all() &&
        (map.translation().array().abs() < largest).all() &&
        std::abs(map.linear().normalizedColumns().determinant()) > flattest))
    throw complaint("cannot be inverted within scales of 1e-9 to 1e9 and places of 1e9 mm");
  return map;
}

} // namespace fenestra
