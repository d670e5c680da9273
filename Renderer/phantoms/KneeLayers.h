#pragma once
// Layers of the knee: order of the shapes, their tissues, and their segments.

#include "phantoms/KneeBones.h"
#include "phantoms/KneeSignal.h"
#include "phantoms/KneeSoftTissue.h"
#include "phantoms/Painter.h"

namespace fenestra {

/// A place with the distances that most layers need.
struct KneeSite {
  Vec3 point;
  double surface;                       ///< mm to the skin's surface
  double fascia;                        ///< mm to the sheath around muscles and joint
  double femur, tibia, fibula, patella; ///< mm to the bones' surfaces
  double femoralCartilage, intactFemoralCartilage, tibialCartilage, patellarCartilage; ///< mm
};

using KneeLayer = PaintLayer<KneeSite, KneeTissue>;

class KneeLayers {
public:
  KneeLayers();

  /// Layers front to back: each hides the later ones.
  const std::vector<KneeLayer>& layers() const { return m_layers; }
  const std::vector<PhantomSegment>& segments() const { return m_segments; }

  KneeSite site(const Vec3& point) const;

private:
  using Distance = std::function<double(const KneeSite&)>;

  /// Adds a segment; returns its label.
  std::uint8_t segment(const char* id, const char* name, const Rgb& color);
  void layer(std::uint8_t label, KneeTissue tissue, const Box& box, Distance distance);
  /// Adds a layer, cut off at the fascia.
  void deepLayer(std::uint8_t label, KneeTissue tissue, const Box& box, Distance distance);
  void ligament(const char* id, const char* name, Tube tube);
  void muscle(const char* id, const char* name, const std::vector<Loft>& bellies);

  void addBones();
  void addCartilage();
  void addLigaments();
  void addMenisci();
  void addJointSpace();
  void addVessels();
  void addMuscles();
  void addCovers();

  KneeBones m_bones;
  LegOutline m_leg;
  std::vector<KneeLayer> m_layers;
  std::vector<PhantomSegment> m_segments;
  std::uint8_t m_deepFat = 0; ///< label of the deep fat
};

} // namespace fenestra
