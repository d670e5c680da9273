#pragma once
// The foot phantom as layers: their order, shapes, tissues and segments.

#include "phantoms/Anatomy.h"
#include "phantoms/FootBones.h"
#include "phantoms/Painter.h"

namespace fenestra::core {

/// A point with the distances that most layers need.
struct FootSite : PaintSite {
  double fascia;              ///< mm to the bottom of the subcutaneous fat
  FootBones::Distances bones; ///< mm
  std::size_t nearest;        ///< index of the nearest bone
  double second;              ///< mm to the second nearest bone
  double shaft;               ///< FootBones::shaftPosition in the nearest bone
  double cancellousBone;      ///< HU, in the nearest bone
};

// Hounsfield units, including the tissue's texture.
double footCortexHu(const FootSite& site);
double footMarrowHu(const FootSite& site);

class FootSubject : public LayeredSubject<FootSite> {
public:
  static constexpr double background = -1000.0; ///< air

  FootSubject();

  FootSite makeSite(const Vec3& point, double reach) const;
  /// Adds noise, and clamps to 12 bits like a scanner.
  std::int16_t acquire(double signal, const Vec3& point, std::uint64_t voxel) const;

private:
  /// Adds layers for `shapes`, cut off `depth` mm below the skin's surface.
  void addShapes(std::uint8_t label, const Field& signal, const std::vector<Solid>& shapes,
                 double depth);

  void addBones();
  void addSoftTissue();
  /// Distance to the skin, mm, without and with the bulges above bones and tendons.
  double outlineDistance(const Vec3& point) const;
  double skinDistance(const Vec3& point, double nearestBone) const;

  Anatomy m_anatomy = loadAnatomy("foot");
  FootBones m_bones;
  Solid m_leg = m_anatomy.at("leg");
  Solid m_body;
  std::vector<Solid> m_toes = m_anatomy.at("toes");
  std::vector<Solid> m_superficial; ///< tendons that raise the skin
};

} // namespace fenestra::core
