#pragma once
// Orientations in which every reader must place a volume.

#include "base/Vector.h"

#include <string>
#include <utility>
#include <vector>

namespace fenestra {

/// Unit axes (columns): axial, sagittal, coronal and oblique; each right- and left-handed.
inline std::vector<std::pair<std::string, Mat3>> listOrientations() {
  const Mat3 axial = Mat3::Identity(), sagittal(Vec3::UnitY(), Vec3::UnitZ(), Vec3::UnitX()),
             coronal(Vec3::UnitX(), Vec3::UnitZ(), -Vec3::UnitY());
  const Mat3 oblique =
      (makeRotation(0.4, Vec3(1, 2, 3).normalized()) * makeRotation(0.3, Vec3::UnitX())).linear();
  std::vector<std::pair<std::string, Mat3>> all;
  for (const auto& [name, axes] : {std::pair("axial", axial),
                                   {"sagittal", sagittal},
                                   {"coronal", coronal},
                                   {"oblique", oblique}}) {
    all.emplace_back(name, axes);
    all.emplace_back(std::string(name) + ", left-handed",
                     Mat3(axes.col(0), axes.col(1), -axes.col(2)));
  }
  return all;
}

} // namespace fenestra
