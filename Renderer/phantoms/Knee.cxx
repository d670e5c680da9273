#include "phantoms/Anatomy.h"
#include "phantoms/KneeBones.h"
#include "phantoms/KneeSignal.h"
#include "phantoms/Noise.h"
#include "phantoms/Painter.h"
#include "phantoms/Phantoms.h"

namespace fenestra::core {

namespace {

const Vec3 kneeFieldOfView{120.0, 137.6, 120.0}; ///< mm along the voxel axes
const Vec3 kneeFieldCenter{0.0, -2.0, 6.8};      ///< world

constexpr double kneeSkinThickness = 1.5;
constexpr double fasciaThickness = 0.6;
constexpr double fluidFilm = 0.7; ///< mm; fluid on the articular surfaces
constexpr double fasciaSignal = 210.0, fluidSignal = 215.0, cortexSignal = 66.0;
constexpr double kneeBoxMargin = 1.5; ///< mm; noise moves surfaces out of their boxes

/// A point with the distances that most layers need.
struct KneeSite : PaintSite {
  double fascia;                        ///< mm to the sheath around muscles and joint
  double femur, tibia, fibula, patella; ///< mm to the bones' surfaces
  double femoralCartilage, intactFemoralCartilage, tibialCartilage, patellarCartilage; ///< mm
  mutable double muscle; ///< mm to the last muscle; the layer of fat behind it has the same box
};

/// Thickness of the cortex, mm: a thin shell at the epiphyses, thicker toward the shafts.
double cortexThickness(const Vec3& p) {
  const double shaft = std::max({0.0, p.z() - 50.0, -25.0 - p.z()});
  return 1.15 + 0.045 * shaft + 0.15 * valueNoise(p / 6.0, 91);
}

// Soft tissue shapes, in the frame of KneeBones.h.

/// Outer surface of the leg; the kneecap protrudes. `trunk`: without kneecap and tubercle.
double legOutline(const Solid& trunk, const Vec3& p) {
  const double kneecap = ellipsoidDistance(p, {2, 34, 38}, {25, 21, 28});
  const double tubercle = ellipsoidDistance(p, {2, 18, -30}, {14, 16, 26});
  const double leg = smoothUnion(smoothUnion(trunk.distance(p), kneecap, 14.0), tubercle, 10.0);
  return leg + 0.5 * valueNoise(p / 14.0, 61);
}

/// Depth of the fascia below the skin's surface, mm: thickness of skin and subcutaneous fat.
double fasciaDepth(const Vec3& p) {
  // Thick at the rear and medially, thin over the kneecap, the tubercle and the shin.
  const double behind = smoothStep(20.0, -45.0, p.y());
  const double medial = smoothStep(10.0, -45.0, p.x()) * smoothStep(40.0, 10.0, p.y());
  return 3.4 + 3.0 * behind + 1.8 * medial + 0.7 * valueNoise(p / 16.0, 62);
}

/// Meniscus before the articular surfaces cut it: a wedge-shaped ring on one tibial plateau, open
/// toward the intercondylar eminence.
struct MeniscusRing {
  Vec2 center;
  Vec2 outerRadii;      ///< mm
  double innerFraction; ///< inner / outer radius, in the middle of the C
  double openingAngle;  ///< half the C's gap, radians, around `opening`
  double opening;       ///< direction to the eminence: 0 lateral, pi medial

  double distance(const Vec3& p) const {
    const Vec2 offset = p.head<2>() - center;
    const Vec2 scaled = offset.cwiseQuotient(outerRadii);
    const double fraction = scaled.norm();
    const double scale = outerRadii.mean();
    double turn = std::atan2(scaled.y(), scaled.x()) - opening;
    turn = std::abs(std::remainder(turn, 2.0 * pi));
    // The horns are thinner than the body and have round ends.
    const double horns = smoothStep(openingAngle + 0.9, openingAngle, turn);
    const double inner = std::lerp(innerFraction, 0.5 * (1.0 + innerFraction), horns);
    const double ring = std::max(fraction - 1.0, inner - fraction) * scale;
    const double ends = (openingAngle - turn) * fraction * scale;
    // The wedge rises from the thin inner edge to 6 mm at the outer edge.
    const double height = 0.6 + 5.4 * std::clamp((fraction - inner) / (1.0 - inner), 0.0, 1.0);
    const double faces = std::max(p.z() - height, -3.6 - p.z());
    return smoothIntersection(smoothIntersection(ring, ends, 3.0), faces, 2.0);
  }
};
constexpr MeniscusRing medialMeniscus{{-20.0, -4.5}, {18.0, 23.5}, 0.56, 0.62, 0.0};
constexpr MeniscusRing lateralMeniscus{{20.0, -5.5}, {17.0, 19.0}, 0.50, 0.42, pi};

/// Thin sheets from the sides of the kneecap to the condyles.
double patellarRetinaculum(const Vec3& p) {
  const double hull = ellipsoidDistance({p.x(), p.y(), 0}, {1.5, 4, 0}, {44.5, 39.5, 1});
  const double sheet = std::abs(hull + 0.6 * valueNoise(p / 12.0, 64)) - 0.35;
  const double front = 4.0 - p.y();
  const double ends = std::abs(p.z() - 24.0) - 37.0 + 0.4 * std::abs(p.x() - 2.0);
  return std::max({sheet, front, ends});
}

double infrapatellarFatPad(const Vec3& p) {
  const double behindLigament = ellipsoidDistance(p, {2, 31, 8}, {24, 15, 20});
  const double low = ellipsoidDistance(p, {2, 26, -8}, {19, 11, 15});
  const double wings = ellipsoidDistance(p, {2, 22, 8}, {34, 15, 13});
  return smoothUnion(smoothUnion(behindLigament, low, 6.0), wings, 6.0);
}

/// Joint cavity above the kneecap, between the quadriceps tendon and the femur.
double suprapatellarRecess(const Vec3& p) {
  const double sheet = ellipsoidDistance(p, {1, 31.5, 60}, {17, 2.4, 14});
  return sheet + 0.5 * valueNoise(p / 6.0, 63);
}

/// Distance to the surface of a bone with its cartilage, `extra` mm thicker; maxDistance where
/// there is no cartilage.
double coverDistance(double bone, double cartilage, double extra) {
  return cartilage > 0.05 ? bone - cartilage - extra : KneeBones::maxDistance;
}

double deepFatSignal(const Vec3& p) {
  return fatSignal(p, 150.0);
}

class KneeSubject : public LayeredSubject<KneeSite> {
public:
  static constexpr double background = 0.0;

  KneeSubject();

  KneeSite makeSite(const Vec3& point, double reach) const;
  std::int16_t acquire(double signal, const Vec3& point, std::uint64_t voxel) const {
    const double noisy = ricianNoise(signal * biasField(point), noiseSigma, voxel);
    return static_cast<std::int16_t>(std::lround(noisy));
  }

private:
  /// Adds a layer, cut off at the fascia.
  void addDeepLayer(std::uint8_t label, Field signal, const Box& box, Field distance) {
    addLayer(label, std::move(signal), box, makeIntersection(std::move(distance), underFascia));
  }
  static double underFascia(const KneeSite& s) { return s.fascia + fasciaThickness; }

  /// Adds a segment for each structure in a list of the anatomy, {"id", "name", "color",
  /// "shapes": [...]}, and calls addShape(label, shape) for each shape. `color`: default for
  /// structures without a color.
  template <typename AddShape>
  void addStructures(const char* kind, const Rgb& color, const AddShape& addShape) {
    for (const Anatomy& entry : m_anatomy.at(kind)) {
      const Vec3 own = entry.value("color", Vec3(color.x(), color.y(), color.z()));
      const auto label = addSegment(entry.at("id"), entry.at("name"), own.array());
      for (const Solid shape : entry.at("shapes"))
        addShape(label, shape);
    }
  }

  void addBones();
  void addCartilage();
  void addLigaments();
  void addMenisci();
  void addJointSpace();
  void addVessels(const char* kind, const Field& signal);
  void addMuscles();
  void addCovers();

  Anatomy m_anatomy = loadAnatomy("knee");
  KneeBones m_bones;
  Solid m_trunk = m_anatomy.at("leg");
  std::uint8_t m_deepFat = 0; ///< label of the intermuscular fat
};

KneeSubject::KneeSubject() : LayeredSubject(kneeBoxMargin) {
  addBones();
  addCartilage();
  addLigaments();
  addMenisci();
  addJointSpace();
  addVessels("vessels", makeConstant(45.0));
  addVessels("nerves", nerveSignal);
  addMuscles();
  addCovers();
}

KneeSite KneeSubject::makeSite(const Vec3& p, double reach) const {
  KneeSite s{};
  s.point = p;
  s.reach = reach;
  s.surface = legOutline(m_trunk, p);
  if (s.surface > reach)
    return s;
  s.fascia = s.surface + fasciaDepth(p);
  s.femur = m_bones.femur(p, reach);
  s.tibia = m_bones.tibia(p, reach);
  s.fibula = m_bones.fibula(p, reach);
  s.patella = m_bones.patella(p, reach);
  const auto isNearBone = [](double distance) { return distance > -2.0 && distance < 5.0; };
  if (isNearBone(s.femur)) {
    s.intactFemoralCartilage = m_bones.intactFemoralCartilage(p);
    s.femoralCartilage = m_bones.applyLesions(s.intactFemoralCartilage, p);
  }
  if (isNearBone(s.tibia))
    s.tibialCartilage = m_bones.tibialCartilage(p);
  if (isNearBone(s.patella))
    s.patellarCartilage = m_bones.patellarCartilage(p);
  return s;
}

void KneeSubject::addBones() {
  const auto bone = [this](const char* id, const char* name, double KneeSite::*surface) {
    const auto label = addSegment(id, name, boneColor);
    addLayer(label, marrowSignal, everywhere, [surface](const KneeSite& s) {
      return s.*surface < 1.0 ? s.*surface + cortexThickness(s.point) : KneeBones::maxDistance;
    });
    addLayer(label, makeConstant(cortexSignal), everywhere,
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
    addLayer(
        addSegment(id, name, cartilageColor), cartilageSignal, everywhere,
        [bone, thickness](const KneeSite& s) { return coverDistance(s.*bone, s.*thickness, 0.0); });
  };
  cartilage("FemoralCartilage", "Femoral cartilage", &KneeSite::femur, &KneeSite::femoralCartilage);
  cartilage("TibialCartilage", "Tibial cartilage", &KneeSite::tibia, &KneeSite::tibialCartilage);
  cartilage("PatellarCartilage", "Patellar cartilage", &KneeSite::patella,
            &KneeSite::patellarCartilage);
}

void KneeSubject::addLigaments() {
  addStructures("ligaments", tendonColor, [this](std::uint8_t label, const Solid& shape) {
    addDeepLayer(label, ligamentSignal, shape.box, shape.distance);
  });
}

void KneeSubject::addMenisci() {
  const auto meniscus = [this](const char* id, const char* name, const MeniscusRing& ring) {
    const Vec3 center{ring.center.x(), ring.center.y(), 2.0};
    const Vec3 halfSize{ring.outerRadii.x(), ring.outerRadii.y(), 6.0};
    addLayer(addSegment(id, name, {0.663, 0.784, 0.702}), meniscusSignal,
             {center - halfSize, center + halfSize}, [ring](const KneeSite& s) {
               const double above = s.femoralCartilage + 0.25 - s.femur;
               const double below = s.tibialCartilage + 0.15 - s.tibia;
               return std::max({ring.distance(s.point), above, below});
             });
  };
  meniscus("MedialMeniscus", "Medial meniscus", medialMeniscus);
  meniscus("LateralMeniscus", "Lateral meniscus", lateralMeniscus);
}

void KneeSubject::addJointSpace() {
  const auto fluid = addSegment("JointFluid", "Joint fluid", {0.667, 0.980, 0.980});
  addLayer(fluid, makeConstant(fluidSignal), everywhere, [](const KneeSite& s) {
    return std::min({coverDistance(s.femur, s.intactFemoralCartilage, fluidFilm),
                     coverDistance(s.tibia, s.tibialCartilage, fluidFilm),
                     coverDistance(s.patella, s.patellarCartilage, fluidFilm)});
  });
  addLayer(fluid, makeConstant(fluidSignal), {{-17, 25, 45}, {19, 38, 75}}, suprapatellarRecess);
  addDeepLayer(addSegment("Retinaculum", "Patellar retinaculum", tendonColor),
               makeConstant(fasciaSignal), {{-46, 0, -14}, {49, 46, 62}}, patellarRetinaculum);
  addDeepLayer(
      addSegment("InfrapatellarFatPad", "Infrapatellar fat pad", {0.882, 0.902, 0.588}),
      [](const Vec3& p) { return fatSignal(p, 300.0) - 15.0; }, {{-35, 6, -25}, {39, 48, 30}},
      infrapatellarFatPad);
}

/// Adds vessels or nerves, cut off below the skin.
void KneeSubject::addVessels(const char* kind, const Field& signal) {
  const auto underSkin = [](const KneeSite& s) { return s.surface + kneeSkinThickness + 0.5; };
  addStructures(kind, vesselColor, [&](std::uint8_t label, const Solid& shape) {
    addLayer(label, signal, shape.box, makeIntersection(shape.distance, underSkin));
  });
}

/// Adds each muscle with a layer of fat that separates it from its neighbors.
void KneeSubject::addMuscles() {
  static constexpr double separation = 0.8; // mm
  m_deepFat = addSegment("IntermuscularFat", "Intermuscular fat", fatColor);
  addStructures("muscles", muscleColor, [this](std::uint8_t label, const Solid& belly) {
    const auto shape = [belly](const KneeSite& s) {
      constexpr double roughness = 0.9, most = roughness + separation;
      const double distance = belly.distance(s.point);
      s.muscle = std::abs(distance) > s.reach + most
                     ? distance
                     : distance + roughness * valueNoise(s.point / 8.0, 92);
      return s.muscle;
    };
    addDeepLayer(label, muscleSignal, belly.box, shape);
    addDeepLayer(m_deepFat, deepFatSignal, belly.box,
                 [](const KneeSite& s) { return s.muscle - separation; });
  });
}

void KneeSubject::addCovers() {
  addLayer(m_deepFat, deepFatSignal, everywhere, underFascia);
  addLayer(addSegment("Fascia", "Fascia", tendonColor), makeConstant(fasciaSignal), everywhere,
           [](const KneeSite& s) { return s.fascia; });
  addLayer(
      addSegment("SubcutaneousFat", "Subcutaneous fat", fatColor),
      [](const Vec3& p) { return fatSignal(p, 190.0); }, everywhere, makeInset(kneeSkinThickness));
  addLayer(addSegment("Skin", "Skin", skinColor), makeConstant(410.0), everywhere, makeInset(0.0));
}

/// Natural colors: pearly cartilage, yellow fat and marrow, red muscle.
VolumeProperty kneeProperty() {
  VolumeProperty property;
  // Air and flow voids are transparent. Cartilage is far denser than signals between its own and
  // that of fluid (215) or cortex (66), so that partial volume adds no muscle red at its surface.
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

} // namespace

Phantom makeKneePhantom(const Size3& size, const PhantomProgress& progress) {
  constexpr Mat3 axes({0, -1, 0}, {0, 0, -1}, {1, 0, 0}); // columns: posterior, inferior, right
  Phantom phantom =
      paintPhantom(KneeSubject(), makePhantomGrid(size, kneeFieldOfView, axes, kneeFieldCenter),
                   "knee", progress);
  phantom.property = kneeProperty();
  return phantom;
}

} // namespace fenestra::core
