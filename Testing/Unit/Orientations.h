#pragma once
// Orientations in which every reader must place a volume, and its corners.

#include "base/Vector.h"
#include "model/volume/Volume.h"

#include <gtest/gtest.h>

#include <functional>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace fenestra::core {

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

/// Expects the values 1 to 8 once each, within 1e-4 mm of locate(0) to locate(7), RAS mm, and
/// smaller values elsewhere: searched by value, since a reader may turn the axes.
inline void expectCorners(const Volume& volume, const std::function<Vec3(int)>& locate) {
  const Size3& size = volume.grid.size;
  std::multiset<int> found;
  std::visit(
      [&](const auto& voxels) {
        for (std::size_t i = 0; i < voxels.size(); ++i)
          if (const int corner = static_cast<int>(voxels[i]) - 1; corner >= 0) {
            const auto at = static_cast<std::int64_t>(i);
            const Vec3 index(double(at % size.x()), double(at / size.x() % size.y()),
                             double(at / size.x() / size.y()));
            EXPECT_LT((volume.grid.indexToWorld * index - locate(corner)).norm(), 1e-4);
            found.insert(corner);
          }
      },
      volume.voxels);
  EXPECT_EQ(found, (std::multiset{0, 1, 2, 3, 4, 5, 6, 7}));
}

} // namespace fenestra::core
