#include "phantoms/Knee.h"

#include "phantoms/Anatomy.h"
#include "phantoms/KneeBones.h"
#include "phantoms/KneeSignal.h"
#include "phantoms/KneeSoftTissue.h"
#include "phantoms/Noise.h"
#include "phantoms/Painter.h"

namespace fenestra {

namespace {

const Vec3 kneeFieldOfView{120.0, 137.6, 120.0}; ///< mm along the voxel axes
const Vec3 kneeFieldCenter{0.0, -2.0, 6.8};      ///< world

constexpr double kneeSkinThickness = 1.5;
constexpr double fasciaThickness = 0.6;
constexpr double film = 0.7; ///< mm; fluid on the joint's faces

/// A place with the distances that most layers need.
struct KneeSite {
  Vec3 point;
  double surface;                       ///< mm to the skin's surface
  double fascia;                        ///< mm to the sheath around muscles and joint
  double femur, tibia, fibula, patella; ///< mm to the bones' surfaces
  double femoralCartilage, intactFemoralCartilage, tibialCartilage, patellarCartilage; ///< mm
};

/// Thickness of the cortex, mm: a thin shell at the epiphyses, thicker toward the shafts.
double cortexThickness(const Vec3& p) {
  const double shaft = std::max({0.0, p.z() - 50.0, -25.0 - p.z()});
  return 1.15 + 0.045 * shaft + 0.15 * valueNoise(p / 6.0, 91);
}

/// Distance to the surface of a bone with its cartilage, `extra` mm thicker; `beyond` where there
/// is no cartilage.
double cover(double bone, double cartilage, double extra) {
  return cartilage > 0.05 ? bone - cartilage - extra : KneeBones::beyond;
}

class KneeSubject : public LayeredSubject<KneeSite, KneeTissue> {
public:
  static constexpr double background = 0.0;

  KneeSubject();

  KneeSite site(const Vec3& point) const;
  double signal(KneeTissue tissue, const KneeSite& site) const {
    return tissueSignal(tissue, site.point);
  }
  std::int16_t acquired(double signal, const Vec3& point, std::uint64_t voxel) const {
    const double noisy = ricianNoise(signal * biasField(point), noiseSigma, voxel);
    return static_cast<std::int16_t>(std::lround(noisy));
  }

private:
  /// Adds a layer, cut off at the fascia.
  void deepLayer(std::uint8_t label, KneeTissue tissue, const Box& box, Distance distance);

  void addBones();
  void addCartilage();
  void addLigaments();
  void addMenisci();
  void addJointSpace();
  void addVessels(const char* kind, KneeTissue tissue);
  void addMuscles();
  void addCovers();

  Anatomy m_anatomy = anatomyOf("knee");
  KneeBones m_bones;
  LegOutline m_leg;
  std::uint8_t m_deepFat = 0; ///< label of the deep fat
};

KneeSubject::KneeSubject() : LayeredSubject(1.5) {
  addBones();
  addCartilage();
  addLigaments();
  addMenisci();
  addJointSpace();
  addVessels("vessels", KneeTissue::vessel);
  addVessels("nerves", KneeTissue::nerve);
  addMuscles();
  addCovers();
}

KneeSite KneeSubject::site(const Vec3& p) const {
  KneeSite s{};
  s.point = p;
  s.surface = m_leg.distance(p);
  s.fascia = s.surface + fasciaDepth(p);
  s.femur = m_bones.femur(p);
  s.tibia = m_bones.tibia(p);
  s.fibula = m_bones.fibula(p);
  s.patella = m_bones.patella(p);
  const auto nearBone = [](double distance) { return distance > -2.0 && distance < 5.0; };
  if (nearBone(s.femur)) {
    s.intactFemoralCartilage = m_bones.intactFemoralCartilage(p);
    s.femoralCartilage = m_bones.femoralCartilage(p);
  }
  if (nearBone(s.tibia))
    s.tibialCartilage = m_bones.tibialCartilage(p);
  if (nearBone(s.patella))
    s.patellarCartilage = m_bones.patellarCartilage(p);
  return s;
}

void KneeSubject::deepLayer(std::uint8_t label, KneeTissue tissue, const Box& box,
                            Distance distance) {
  layer(label, tissue, box, [distance = std::move(distance)](const KneeSite& s) {
    return std::max(distance(s), s.fascia + fasciaThickness);
  });
}

void KneeSubject::addBones() {
  const auto bone = [this](const char* id, const char* name, double KneeSite::*surface) {
    const auto label = segment(id, name, boneColor);
    layer(label, KneeTissue::marrow, everywhere, [surface](const KneeSite& s) {
      return s.*surface < 1.0 ? s.*surface + cortexThickness(s.point) : KneeBones::beyond;
    });
    layer(label, KneeTissue::cortex, everywhere,
          [surface](const KneeSite& s) { return s.*surface; });
  };
  bone("Femur", "Femur", &KneeSite::femur);
  bone("Tibia", "Tibia", &KneeSite::tibia);
  bone("Fibula", "Fibula", &KneeSite::fibula);
  bone("Patella", "Patella", &KneeSite::patella);
}

void KneeSubject::addCartilage() {
  const auto cartilage = [this](const char* id, const char* name, double KneeSite::*bone,
                                double KneeSite::*thickness) {
    layer(segment(id, name, cartilageColor), KneeTissue::cartilage, everywhere,
          [bone, thickness](const KneeSite& s) { return cover(s.*bone, s.*thickness, 0.0); });
  };
  cartilage("FemoralCartilage", "Femoral cartilage", &KneeSite::femur, &KneeSite::femoralCartilage);
  cartilage("TibialCartilage", "Tibial cartilage", &KneeSite::tibia, &KneeSite::tibialCartilage);
  cartilage("PatellarCartilage", "Patellar cartilage", &KneeSite::patella,
            &KneeSite::patellarCartilage);
}

void KneeSubject::addLigaments() {
  for (const Structure& ligament : structures(m_anatomy.at("ligaments"), tendonColor)) {
    const auto label = segment(ligament.id, ligament.name, ligament.color);
    for (const Solid& shape : ligament.shapes)
      deepLayer(label, KneeTissue::ligament, shape.box, distanceTo(shape));
  }
}

void KneeSubject::addMenisci() {
  const auto meniscus = [this](const char* id, const char* name, const MeniscusRing& ring) {
    const Vec3 center{ring.center.x(), ring.center.y(), 2.0};
    const Vec3 reach{ring.outerRadii.x(), ring.outerRadii.y(), 6.0};
    layer(segment(id, name, {0.663, 0.784, 0.702}), KneeTissue::meniscus,
          {center - reach, center + reach}, [ring](const KneeSite& s) {
            const double above = s.femoralCartilage + 0.25 - s.femur;
            const double below = s.tibialCartilage + 0.15 - s.tibia;
            return std::max({ring.distance(s.point), above, below});
          });
  };
  meniscus("MedialMeniscus", "Medial meniscus", medialMeniscus());
  meniscus("LateralMeniscus", "Lateral meniscus", lateralMeniscus());
}

void KneeSubject::addJointSpace() {
  const auto fluid = segment("JointFluid", "Joint fluid", {0.667, 0.980, 0.980});
  layer(fluid, KneeTissue::fluid, everywhere, [](const KneeSite& s) {
    return std::min({cover(s.femur, s.intactFemoralCartilage, film),
                     cover(s.tibia, s.tibialCartilage, film),
                     cover(s.patella, s.patellarCartilage, film)});
  });
  layer(fluid, KneeTissue::fluid, {{-17, 25, 45}, {19, 38, 75}},
        [](const KneeSite& s) { return suprapatellarRecess(s.point); });

  const auto retinaculum = segment("Retinaculum", "Patellar retinaculum", tendonColor);
  deepLayer(retinaculum, KneeTissue::fascia, {{-46, 0, -14}, {49, 46, 62}},
            [](const KneeSite& s) { return patellarRetinaculum(s.point); });
  const auto fatPad =
      segment("InfrapatellarFatPad", "Infrapatellar fat pad", {0.882, 0.902, 0.588});
  deepLayer(fatPad, KneeTissue::fatPad, {{-35, 6, -25}, {39, 48, 30}},
            [](const KneeSite& s) { return infrapatellarFatPad(s.point); });
}

/// Adds vessels or nerves, cut off under the skin.
void KneeSubject::addVessels(const char* kind, KneeTissue tissue) {
  for (const Structure& vessel : structures(m_anatomy.at(kind), vesselColor)) {
    const auto label = segment(vessel.id, vessel.name, vessel.color);
    for (const Solid& shape : vessel.shapes)
      layer(label, tissue, shape.box, [shape](const KneeSite& s) {
        return std::max(shape.distance(s.point), s.surface + kneeSkinThickness + 0.5);
      });
  }
}

/// Adds each muscle with a layer of fat, which separates neighbouring muscles.
void KneeSubject::addMuscles() {
  m_deepFat = segment("IntermuscularFat", "Intermuscular fat", fatColor);
  for (const Structure& muscle : structures(m_anatomy.at("muscles"), muscleColor)) {
    const auto label = segment(muscle.id, muscle.name, muscle.color);
    for (const Solid& belly : muscle.shapes) {
      const Distance shape = [belly](const KneeSite& s) {
        return belly.distance(s.point) + 0.9 * valueNoise(s.point / 8.0, 92);
      };
      deepLayer(label, KneeTissue::muscle, belly.box, shape);
      deepLayer(m_deepFat, KneeTissue::deepFat, belly.box,
                [shape](const KneeSite& s) { return shape(s) - 0.8; });
    }
  }
}

void KneeSubject::addCovers() {
  layer(m_deepFat, KneeTissue::deepFat, everywhere,
        [](const KneeSite& s) { return s.fascia + fasciaThickness; });
  layer(segment("Fascia", "Fascia", tendonColor), KneeTissue::fascia, everywhere,
        [](const KneeSite& s) { return s.fascia; });
  layer(segment("SubcutaneousFat", "Subcutaneous fat", fatColor), KneeTissue::subcutaneousFat,
        everywhere, [](const KneeSite& s) { return s.surface + kneeSkinThickness; });
  layer(segment("Skin", "Skin", skinColor), KneeTissue::skin, everywhere,
        [](const KneeSite& s) { return s.surface; });
}

} // namespace

Phantom makeKneePhantom(const KneeOptions& options) {
  requirePhantomSize(options.size);
  constexpr Mat3 axes({0, -1, 0}, {0, 0, -1}, {1, 0, 0}); // columns: posterior, inferior, right
  Phantom phantom = paintPhantom(
      KneeSubject(), phantomGrid(options.size, kneeFieldOfView, axes, kneeFieldCenter), "knee");
  phantom.property = kneeProperty();
  return phantom;
}

VolumeProperty kneeProperty() {
  VolumeProperty property;
  // Air and flow voids are transparent. Cartilage is far denser than the values between its own and
  // those of fluid (215) or cortex (66): partial volume shows no muscle red on its border.
  property.scalarOpacity = {{0, 0},      {46, 0},     {70, 0.30},  {130, 0.42}, {185, 0.20},
                            {240, 0.14}, {300, 0.30}, {350, 0.42}, {400, 0.40}, {450, 0.75},
                            {500, 0.97}, {580, 0.97}, {650, 0.60}, {740, 0.45}, {1200, 0.50}};
  property.gradientOpacity = {{0, 1}, {2000, 1}};
  property.color = {{0, {0.90, 0.84, 0.76}},   {70, {0.93, 0.88, 0.80}},  {130, {0.95, 0.91, 0.85}},
                    {190, {0.92, 0.84, 0.78}}, {250, {0.86, 0.60, 0.53}}, {310, {0.80, 0.42, 0.35}},
                    {370, {0.82, 0.44, 0.37}}, {415, {0.91, 0.71, 0.61}}, {455, {0.93, 0.93, 0.95}},
                    {500, {0.94, 0.96, 0.98}}, {590, {0.94, 0.96, 0.97}}, {650, {0.97, 0.94, 0.82}},
                    {740, {0.97, 0.86, 0.65}}, {810, {0.97, 0.86, 0.62}}, {870, {0.98, 0.90, 0.68}},
                    {960, {0.99, 0.93, 0.76}}};
  property.shade = true;
  property.specular = 0.25;
  property.specularPower = 20.0;
  return property;
}

} // namespace fenestra
