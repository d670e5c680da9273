#pragma once
// A synthetic chest in CT: lungs with a vessel each, the trachea, gas in the bowel, a spine, and
// air around.

#include "model/volume/Volume.h"

namespace fenestra::core {

struct SyntheticChest {
  bool hasLungs = true;

  static bool isEllipsoid(const Vec3& p, const Vec3& center, const Vec3& radii) {
    return ((p - center).array() / radii.array()).matrix().squaredNorm() < 1.0;
  }
  static bool isLung(const Vec3& p) {
    return isEllipsoid(p, {-70, 0, 30}, {50, 60, 80}) || isEllipsoid(p, {70, 0, 30}, {50, 60, 80});
  }
  /// Vessels of 6 mm along the lungs.
  static bool isVessel(const Vec3& p) {
    return isLung(p) && Vec3(std::abs(p.x()) - 70.0, p.y(), 0.0).norm() < 3.0;
  }

  /// HU at a point, mm: right, anterior, superior.
  double value(const Vec3& p) const {
    constexpr double air = -1000.0, lung = -850.0, tissue = 40.0, bone = 400.0;
    if (!isEllipsoid({p.x(), p.y(), 0.0}, Vec3::Zero(), {160, 100, 1}))
      return air;
    if (isEllipsoid({p.x(), p.y(), 0.0}, {0, -75, 0}, {15, 15, 1}))
      return bone;
    const bool isBowel = isEllipsoid(p, {60, 30, -110}, {45, 45, 30});
    const bool isTrachea = Vec3(p.x(), p.y(), 0.0).norm() < 8.0 && p.z() > 60.0;
    const bool isBronchus = std::abs(p.z() - 62.0) < 5.0 && std::abs(p.y()) < 5.0 &&
                            std::abs(p.x()) < 70.0 && !isVessel(p);
    if (isBowel || (hasLungs && (isTrachea || isBronchus)))
      return air;
    return hasLungs && isLung(p) && !isVessel(p) ? lung : tissue;
  }

  /// Voxels of 3 mm.
  Volume volume() const {
    const Size3 size(120, 76, 96);
    const Vec3 spacing = Vec3::Constant(3.0);
    const Vec3 half = spacing.cwiseProduct((size.cast<double>().array() - 1.0) * 0.5);
    Volume ct;
    ct.grid = {size, Affine(Mat3::Diagonal(spacing), -half)};
    ct.modality = Modality::ct;
    LargeArray<std::int16_t> voxels;
    for (std::int64_t z = 0; z < size.z(); ++z)
      for (std::int64_t y = 0; y < size.y(); ++y)
        for (std::int64_t x = 0; x < size.x(); ++x)
          voxels.push_back(static_cast<std::int16_t>(
              value(ct.grid.indexToWorld * Vec3(Size3(x, y, z).cast<double>()))));
    ct.voxels = std::move(voxels);
    computeRange(ct);
    return ct;
  }
};

} // namespace fenestra::core
