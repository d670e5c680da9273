#pragma once
// What a clip leaves, from its description.

#include "Matter.h"
#include "View.h"

namespace fenestra::oracle {

/// The interpolated indicator of a mask at a world point; 0 outside its voxels.
double indicatorAt(const Mask& mask, const Vec3& world);

class Clipping {
public:
  /// For a depth clip, builds the whole buffer.
  Clipping(const ClipDescription& description, const View& view, const Matter& matter);

  /// 0 to 1.
  double keep(const Vec3& world) const;

  /// Depths of a depth clip, mm, row by row; -infinity where a cutaway removes nothing.
  const std::vector<double>& depths() const { return m_depths; }

private:
  double surface(const Vec2& at) const;
  double surfaceInSeam(const DepthClip::Seam& seam, const Vec2& at, double between) const;

  const ClipDescription& m_description;
  const View& m_view;
  const Matter& m_matter;
  std::vector<double> m_depths;
};

} // namespace fenestra::oracle
