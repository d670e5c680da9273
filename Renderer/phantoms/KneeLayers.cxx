#include "phantoms/KneeLayers.h"

#include "phantoms/Noise.h"

namespace fenestra {

namespace {

constexpr double kneeSkinThickness = 1.5;
constexpr double fasciaThickness = 0.6;
constexpr double film = 0.7; ///< mm; fluid on the joint's faces

const Rgb cartilageColor{0.435, 0.722, 0.824};
const Rgb meniscusColor{0.663, 0.784, 0.702};
const Rgb ligamentColor{0.718, 0.839, 0.827};
const Rgb muscleColor{0.753, 0.408, 0.345};
const Rgb fatColor{0.902, 0.863, 0.275};

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

} // namespace

KneeLayers::KneeLayers() {
  addBones();
  addCartilage();
  addLigaments();
  addMenisci();
  addJointSpace();
  addVessels();
  addMuscles();
  addCovers();
}

KneeSite KneeLayers::site(const Vec3& p) const {
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

std::uint8_t KneeLayers::segment(const char* id, const char* name, const Rgb& color) {
  const auto label = static_cast<std::uint8_t>(m_segments.size() + 1);
  m_segments.push_back({id, name, color, label});
  return label;
}

void KneeLayers::layer(std::uint8_t label, KneeTissue tissue, const Box& box, Distance distance) {
  m_layers.push_back({label, tissue, expanded(box, boxMargin), std::move(distance)});
}

void KneeLayers::deepLayer(std::uint8_t label, KneeTissue tissue, const Box& box,
                           Distance distance) {
  layer(label, tissue, box, [distance = std::move(distance)](const KneeSite& s) {
    return std::max(distance(s), s.fascia + fasciaThickness);
  });
}

void KneeLayers::ligament(const char* id, const char* name, Tube tube) {
  const Box box = tube.box();
  deepLayer(segment(id, name, ligamentColor), KneeTissue::ligament, box,
            [tube = std::move(tube)](const KneeSite& s) { return tube.distance(s.point); });
}

/// Adds a muscle with a layer of fat, which separates neighbouring muscles.
void KneeLayers::muscle(const char* id, const char* name, const std::vector<Loft>& bellies) {
  const auto label = segment(id, name, muscleColor);
  for (const Loft& belly : bellies) {
    const Distance shape = [belly](const KneeSite& s) {
      return belly.distance(s.point) + 0.9 * valueNoise(s.point / 8.0, 92);
    };
    deepLayer(label, KneeTissue::muscle, belly.box(), shape);
    deepLayer(m_deepFat, KneeTissue::deepFat, belly.box(),
              [shape](const KneeSite& s) { return shape(s) - 0.8; });
  }
}

void KneeLayers::addBones() {
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

void KneeLayers::addCartilage() {
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

void KneeLayers::addLigaments() {
  ligament("ACL", "Anterior cruciate ligament", anteriorCruciateLigament());
  ligament("PCL", "Posterior cruciate ligament", posteriorCruciateLigament());
  ligament("MCL", "Medial collateral ligament", medialCollateralLigament());
  ligament("LCL", "Lateral collateral ligament", lateralCollateralLigament());
  ligament("PatellarLigament", "Patellar ligament", patellarLigament());
  ligament("QuadricepsTendon", "Quadriceps tendon", quadricepsTendon());
  ligament("IliotibialBand", "Iliotibial band", iliotibialBand());
  ligament("SemitendinosusTendon", "Semitendinosus tendon", semitendinosusTendon());
}

void KneeLayers::addMenisci() {
  const auto meniscus = [this](const char* id, const char* name, const MeniscusRing& ring) {
    const Vec3 center{ring.center.x(), ring.center.y(), 2.0};
    const Vec3 reach{ring.outerRadii.x(), ring.outerRadii.y(), 6.0};
    layer(segment(id, name, meniscusColor), KneeTissue::meniscus, {center - reach, center + reach},
          [ring](const KneeSite& s) {
            const double above = s.femoralCartilage + 0.25 - s.femur;
            const double below = s.tibialCartilage + 0.15 - s.tibia;
            return std::max({ring.distance(s.point), above, below});
          });
  };
  meniscus("MedialMeniscus", "Medial meniscus", medialMeniscus());
  meniscus("LateralMeniscus", "Lateral meniscus", lateralMeniscus());
}

void KneeLayers::addJointSpace() {
  const auto fluid = segment("JointFluid", "Joint fluid", {0.667, 0.980, 0.980});
  layer(fluid, KneeTissue::fluid, everywhere, [](const KneeSite& s) {
    return std::min({cover(s.femur, s.intactFemoralCartilage, film),
                     cover(s.tibia, s.tibialCartilage, film),
                     cover(s.patella, s.patellarCartilage, film)});
  });
  layer(fluid, KneeTissue::fluid, {{-17, 25, 45}, {19, 38, 75}},
        [](const KneeSite& s) { return suprapatellarRecess(s.point); });

  const auto retinaculum = segment("Retinaculum", "Patellar retinaculum", ligamentColor);
  deepLayer(retinaculum, KneeTissue::fascia, {{-46, 0, -14}, {49, 46, 62}},
            [](const KneeSite& s) { return patellarRetinaculum(s.point); });
  const auto fatPad =
      segment("InfrapatellarFatPad", "Infrapatellar fat pad", {0.882, 0.902, 0.588});
  deepLayer(fatPad, KneeTissue::fatPad, {{-35, 6, -25}, {39, 48, 30}},
            [](const KneeSite& s) { return infrapatellarFatPad(s.point); });
}

void KneeLayers::addVessels() {
  const auto add = [this](std::uint8_t label, KneeTissue tissue, Tube tube) {
    const Box box = tube.box();
    layer(label, tissue, box, [tube = std::move(tube)](const KneeSite& s) {
      return std::max(tube.distance(s.point), s.surface + kneeSkinThickness + 0.5);
    });
  };
  const Rgb veinColor{0.0, 0.592, 0.808};
  add(segment("PoplitealArtery", "Popliteal artery", {0.847, 0.396, 0.310}), KneeTissue::vessel,
      poplitealArtery());
  add(segment("PoplitealVein", "Popliteal vein", veinColor), KneeTissue::vessel, poplitealVein());
  add(segment("SaphenousVein", "Great saphenous vein", veinColor), KneeTissue::vessel,
      saphenousVein());
  add(segment("TibialNerve", "Tibial nerve", {0.957, 0.839, 0.192}), KneeTissue::nerve,
      tibialNerve());
}

void KneeLayers::addMuscles() {
  m_deepFat = segment("IntermuscularFat", "Intermuscular fat", fatColor);
  muscle("VastusMedialis", "Vastus medialis muscle", vastusMedialis());
  muscle("VastusLateralis", "Vastus lateralis muscle", vastusLateralis());
  muscle("Quadriceps", "Rectus femoris and vastus intermedius muscles", quadricepsBelly());
  muscle("Semimembranosus", "Semimembranosus muscle", semimembranosus());
  muscle("BicepsFemoris", "Biceps femoris muscle", bicepsFemoris());
  muscle("SartoriusGracilis", "Sartorius and gracilis muscles", sartoriusAndGracilis());
  muscle("MedialGastrocnemius", "Medial gastrocnemius muscle", medialGastrocnemius());
  muscle("LateralGastrocnemius", "Lateral gastrocnemius muscle", lateralGastrocnemius());
  muscle("Popliteus", "Popliteus muscle", popliteus());
  muscle("Soleus", "Soleus muscle", soleus());
  muscle("TibialisAnterior", "Tibialis anterior muscle", tibialisAnterior());
  muscle("Peroneus", "Peroneus longus muscle", peroneus());
}

void KneeLayers::addCovers() {
  layer(m_deepFat, KneeTissue::deepFat, everywhere,
        [](const KneeSite& s) { return s.fascia + fasciaThickness; });
  layer(segment("Fascia", "Fascia", ligamentColor), KneeTissue::fascia, everywhere,
        [](const KneeSite& s) { return s.fascia; });
  layer(segment("SubcutaneousFat", "Subcutaneous fat", fatColor), KneeTissue::subcutaneousFat,
        everywhere, [](const KneeSite& s) { return s.surface + kneeSkinThickness; });
  layer(segment("Skin", "Skin", {0.694, 0.478, 0.396}), KneeTissue::skin, everywhere,
        [](const KneeSite& s) { return s.surface; });
}

} // namespace fenestra
