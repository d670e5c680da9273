#pragma once
// Layers of the foot: order of the shapes, their tissues, and their segments.

#include "phantoms/FootBones.h"
#include "phantoms/Painter.h"

namespace fenestra {

enum class FootTissue { cortex, marrow, cartilage, tendon, vessel, muscle, fat, skin };

/// A place with the distances that most layers need.
struct FootSite {
  Vec3 point;
  double surface;             ///< mm to the skin's surface
  double fascia;              ///< mm to the bottom of the subcutaneous fat
  FootBones::Distances bones; ///< mm
  std::size_t nearest;        ///< index of the nearest bone
  double second;              ///< mm to the second nearest bone
  double shaft;               ///< FootBones::shaft of the nearest bone
};

/// Surface of the skin without the bulges of bones and tendons.
class FootOutline {
public:
  FootOutline();
  double distance(const Vec3& point) const; ///< mm

private:
  Solid m_leg, m_body;
  std::vector<Solid> m_toes;
};

class FootLayers : public LayeredSubject<FootSite, FootTissue> {
public:
  static constexpr double background = -1000.0; ///< air

  FootLayers();

  FootSite site(const Vec3& point) const;
  /// Hounsfield units, with the tissue's own texture.
  double signal(FootTissue tissue, const FootSite& site) const;
  /// Adds noise, and clips to 12 bits like a scanner.
  std::int16_t acquired(double signal, const Vec3& point, std::uint64_t voxel) const;

private:
  /// Adds shapes, cut off `depth` mm under the skin's surface.
  void shapes(std::uint8_t label, FootTissue tissue, const std::vector<Solid>& shapes,
              double depth);

  void addBones();
  void addSoftTissue();
  double surface(const Vec3& point, double nearestBone) const;

  FootBones m_bones;
  FootOutline m_outline;
  std::vector<Solid> m_superficial; ///< tendons that raise the skin
};

} // namespace fenestra
