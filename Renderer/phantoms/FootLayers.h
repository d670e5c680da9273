#pragma once
// Layers of the foot: order of the shapes, their tissues, and their segments.

#include "phantoms/FootBones.h"
#include "phantoms/FootSoftTissue.h"
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

using FootLayer = PaintLayer<FootSite, FootTissue>;

class FootLayers {
public:
  FootLayers();

  /// Layers front to back: each hides the later ones.
  const std::vector<FootLayer>& layers() const { return m_layers; }
  const std::vector<PhantomSegment>& segments() const { return m_segments; }

  FootSite site(const Vec3& point) const;
  /// Hounsfield units, with the tissue's own texture.
  double signal(FootTissue tissue, const FootSite& site) const;

private:
  using Distance = std::function<double(const FootSite&)>;

  /// Adds a segment; returns its label.
  std::uint8_t segment(const std::string& id, const std::string& name, const Rgb& color);
  void layer(std::uint8_t label, FootTissue tissue, const Box& box, Distance distance);
  /// Adds tubes, cut off `depth` mm under the skin's surface.
  void tubes(std::uint8_t label, FootTissue tissue, const std::vector<Tube>& tubes, double depth);

  void addBones();
  void addSoftTissue();
  double surface(const Vec3& point, double nearestBone) const;

  FootBones m_bones;
  FootOutline m_outline;
  std::vector<Tube> m_superficial; ///< tendons that raise the skin
  std::vector<FootLayer> m_layers;
  std::vector<PhantomSegment> m_segments;
};

} // namespace fenestra
