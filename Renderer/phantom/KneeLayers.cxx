#include "phantom/KneeLayers.h"

#include "phantom/Noise.h"

namespace fenestra {

namespace {

constexpr double boxMargin = 1.5; ///< mm: soft borders reach this far past a shape
constexpr double skinThickness = 1.5;
constexpr double film = 0.7; ///< mm of fluid on the joint's faces

const Box everywhere{Vec3::Constant(-infinity), Vec3::Constant(infinity)};

const Rgb boneColor{0.945, 0.839, 0.569};
const Rgb cartilageColor{0.435, 0.722, 0.824};
const Rgb meniscusColor{0.663, 0.784, 0.702};
const Rgb ligamentColor{0.718, 0.839, 0.827};
const Rgb muscleColor{0.753, 0.408, 0.345};
const Rgb fatColor{0.902, 0.863, 0.275};

/// Epiphyses have a thin shell; toward the shafts it grows.
double cortexThickness(const Vec3& p) {
  const double shaft = std::max({0.0, p.z() - 50.0, -25.0 - p.z()});
  return 1.15 + 0.045 * shaft + 0.15 * valueNoise(p / 6.0, 91);
}

/// Distance to the surface of a bone with its cartilage, `extra` mm thicker; far where there is
/// none.
double cover(double bone, double cartilage, double extra) {
  return cartilage > 0.05 ? bone - cartilage - extra : KneeBones::beyond;
}

} // namespace

KneeLayers::KneeLayers() {
  addBones();
  addCartilage();
  addLigaments();
  addJointSpace();
  addVessels();
  addMuscles();
  addCovers();
}

Site KneeLayers::site(const Vec3& p) const {
  Site s{};
  s.point = p;
  s.leg = m_leg.distance(p);
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

void KneeLayers::segment(const char* id, const char* name, const Rgb& color) {
  m_segments.push_back({id, name, color, static_cast<std::uint8_t>(m_segments.size() + 1)});
}

void KneeLayers::layer(Tissue tissue, const Box& box, Distance distance) {
  m_layers.push_back(
      {m_segments.back().label, tissue, expanded(box, boxMargin), std::move(distance)});
}

void KneeLayers::band(Tissue tissue, Tube tube) {
  const Box box = tube.box();
  layer(tissue, box, [tube = std::move(tube)](const Site& s) { return tube.distance(s.point); });
}

void KneeLayers::muscle(const char* id, const char* name, std::vector<Loft> bellies) {
  segment(id, name, muscleColor);
  for (Loft& belly : bellies) {
    const Box box = belly.box();
    layer(Tissue::muscle, box, [belly = std::move(belly)](const Site& s) {
      return belly.distance(s.point) + 0.6 * valueNoise(s.point / 8.0, 92);
    });
  }
}

void KneeLayers::addBones() {
  const auto bone = [this](const char* id, const char* name, double Site::*surface) {
    segment(id, name, boneColor);
    layer(Tissue::marrow, everywhere, [surface](const Site& s) {
      return s.*surface < 1.0 ? s.*surface + cortexThickness(s.point) : KneeBones::beyond;
    });
    layer(Tissue::cortex, everywhere, [surface](const Site& s) { return s.*surface; });
  };
  bone("Femur", "Femur", &Site::femur);
  bone("Tibia", "Tibia", &Site::tibia);
  bone("Fibula", "Fibula", &Site::fibula);
  bone("Patella", "Patella", &Site::patella);
}

void KneeLayers::addCartilage() {
  segment("FemoralCartilage", "Femoral cartilage", cartilageColor);
  layer(Tissue::cartilage, everywhere,
        [](const Site& s) { return cover(s.femur, s.femoralCartilage, 0.0); });
  segment("TibialCartilage", "Tibial cartilage", cartilageColor);
  layer(Tissue::cartilage, everywhere,
        [](const Site& s) { return cover(s.tibia, s.tibialCartilage, 0.0); });
  segment("PatellarCartilage", "Patellar cartilage", cartilageColor);
  layer(Tissue::cartilage, everywhere,
        [](const Site& s) { return cover(s.patella, s.patellarCartilage, 0.0); });
}

void KneeLayers::addLigaments() {
  const auto ligament = [this](const char* id, const char* name, Tube tube) {
    segment(id, name, ligamentColor);
    band(Tissue::ligament, std::move(tube));
  };
  ligament("ACL", "Anterior cruciate ligament", anteriorCruciateLigament());
  ligament("PCL", "Posterior cruciate ligament", posteriorCruciateLigament());
  ligament("MCL", "Medial collateral ligament", medialCollateralLigament());
  ligament("LCL", "Lateral collateral ligament", lateralCollateralLigament());
  ligament("PatellarLigament", "Patellar ligament", patellarLigament());
  ligament("QuadricepsTendon", "Quadriceps tendon", quadricepsTendon());
  ligament("IliotibialBand", "Iliotibial band", iliotibialBand());
  ligament("SemitendinosusTendon", "Semitendinosus tendon", semitendinosusTendon());
}

void KneeLayers::addJointSpace() {
  const auto meniscus = [this](const char* id, const char* name, const MeniscusRing& ring) {
    segment(id, name, meniscusColor);
    const Vec3 center{ring.center.x(), ring.center.y(), 2.0};
    const Vec3 reach{ring.outerRadii.x(), ring.outerRadii.y(), 6.0};
    layer(Tissue::meniscus, {center - reach, center + reach}, [ring](const Site& s) {
      const double above = s.femoralCartilage + 0.25 - s.femur;
      const double below = s.tibialCartilage + 0.15 - s.tibia;
      return std::max({ring.distance(s.point), above, below});
    });
  };
  meniscus("MedialMeniscus", "Medial meniscus", medialMeniscus());
  meniscus("LateralMeniscus", "Lateral meniscus", lateralMeniscus());

  segment("JointFluid", "Joint fluid", {0.667, 0.980, 0.980});
  layer(Tissue::fluid, everywhere, [](const Site& s) {
    return std::min({cover(s.femur, s.intactFemoralCartilage, film),
                     cover(s.tibia, s.tibialCartilage, film),
                     cover(s.patella, s.patellarCartilage, film)});
  });
  layer(Tissue::fluid, {{-17, 25, 45}, {19, 38, 75}},
        [](const Site& s) { return suprapatellarRecess(s.point); });

  segment("InfrapatellarFatPad", "Infrapatellar fat pad", {0.882, 0.902, 0.588});
  layer(Tissue::fatPad, {{-35, 6, -25}, {39, 48, 30}},
        [](const Site& s) { return infrapatellarFatPad(s.point); });
}

void KneeLayers::addVessels() {
  segment("PoplitealArtery", "Popliteal artery", {0.847, 0.396, 0.310});
  band(Tissue::vessel, poplitealArtery());
  segment("PoplitealVein", "Popliteal vein", {0.0, 0.592, 0.808});
  band(Tissue::vessel, poplitealVein());
  segment("SaphenousVein", "Great saphenous vein", {0.0, 0.592, 0.808});
  band(Tissue::vessel, saphenousVein());
  segment("TibialNerve", "Tibial nerve", {0.957, 0.839, 0.192});
  band(Tissue::nerve, tibialNerve());
}

void KneeLayers::addMuscles() {
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
  constexpr double fasciaThickness = 0.6;
  segment("IntermuscularFat", "Intermuscular fat", fatColor);
  layer(Tissue::deepFat, everywhere,
        [](const Site& s) { return s.leg + fasciaDepth(s.point) + fasciaThickness; });
  segment("Fascia", "Fascia", ligamentColor);
  layer(Tissue::fascia, everywhere, [](const Site& s) { return s.leg + fasciaDepth(s.point); });
  segment("SubcutaneousFat", "Subcutaneous fat", fatColor);
  layer(Tissue::subcutaneousFat, everywhere, [](const Site& s) { return s.leg + skinThickness; });
  segment("Skin", "Skin", {0.694, 0.478, 0.396});
  layer(Tissue::skin, everywhere, [](const Site& s) { return s.leg; });
}

} // namespace fenestra
