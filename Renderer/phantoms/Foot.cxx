#include "phantoms/Foot.h"

#include "phantoms/Noise.h"
#include "phantoms/Phantoms.h"

namespace fenestra::core {

namespace {

const Vec3 footFieldOfView{280.0, 112.0, 140.0}; ///< mm along the voxel axes
const Vec3 footFieldCenter{-2.0, 131.0, 64.0};   ///< world
constexpr int footBoneThreshold = 200;           ///< HU
constexpr double footSkinThickness = 1.6;        ///< mm
constexpr double footNoise = 14.0;               ///< HU, standard deviation
constexpr double footBoxMargin = 1.5;            ///< mm; noise moves surfaces out of their boxes

/// HU relative to the mean.
double trabecularTexture(const Vec3& p) {
  return 90.0 * valueNoise(p / 1.6, 270) + 60.0 * valueNoise(p / 4.0, 271);
}

/// Height of the sole above the floor, mm: the medial arch.
double soleHeight(const Vec3& p) {
  const double across = (p.x() + 40.0) / 24.0, along = (p.y() - 112.0) / 42.0;
  return 16.0 * std::exp(-across * across - along * along);
}

/// Thickness of skin and subcutaneous fat, mm; largest under the sole.
double footFasciaDepth(const Vec3& p) {
  const double plantar = smoothStep(20.0, 6.0, p.z()) * smoothStep(205.0, 190.0, p.y());
  const double heel = smoothStep(45.0, 20.0, p.y()) * smoothStep(30.0, 12.0, p.z());
  const double leg = smoothStep(70.0, 110.0, p.z());
  return 2.8 + 3.2 * plantar + 4.5 * heel + 1.6 * leg + 0.4 * valueNoise(p / 14.0, 262);
}

double footTendonHu(const Vec3& p) {
  return 105.0 + 10.0 * valueNoise(p / 2.0, 273);
}
double footMuscleHu(const Vec3& p) {
  return 55.0 + 12.0 * valueNoise(p.cwiseQuotient(Vec3{3.0, 9.0, 3.0}), 274);
}
double footFatHu(const Vec3& p) {
  return -105.0 + 12.0 * valueNoise(p / 5.0, 275);
}

/// Adds layer 1: all voxels at or above footBoneThreshold.
void addThresholdedBones(Phantom& phantom) {
  const auto& voxels = std::get<LargeArray<std::int16_t>>(phantom.volume.voxels);
  std::vector<std::uint8_t> bones(voxels.size());
  for (std::size_t i = 0; i < voxels.size(); ++i)
    bones[i] = voxels[i] >= footBoneThreshold;
  phantom.labels.layers.push_back(std::move(bones));
  phantom.segments.push_back({"bones", "Bones", {0.945, 0.902, 0.784}, 1, 1});
}

/// Ivory bones in translucent skin, fat, muscle and tendon.
VolumeProperty footProperty() {
  VolumeProperty property;
  property.scalarOpacity = {{-1024, 0},  {-600, 0},   {-300, 0.03}, {-120, 0.03}, {-30, 0.03},
                            {20, 0.08},  {60, 0.10},  {90, 0.14},   {120, 0.28},  {160, 0.42},
                            {210, 0.88}, {400, 0.98}, {3071, 0.99}};
  property.gradientOpacity = {{0, 1}, {2000, 1}};
  property.color = {{-1024, {0.95, 0.78, 0.68}}, {-300, {0.95, 0.78, 0.68}},
                    {-120, {0.97, 0.84, 0.62}},  {-30, {0.93, 0.68, 0.55}},
                    {50, {0.80, 0.42, 0.36}},    {85, {0.86, 0.62, 0.54}},
                    {115, {0.93, 0.87, 0.80}},   {200, {0.94, 0.88, 0.76}},
                    {500, {0.96, 0.92, 0.82}},   {3071, {0.98, 0.96, 0.90}}};
  property.shade = true;
  property.specularPower = 15.0;
  return property;
}

} // namespace

double footCortexHu(const FootSite& s) {
  return std::lerp(820.0, 1450.0, s.shaft) + 90.0 * valueNoise(s.point / 3.0, 272);
}

double footMarrowHu(const FootSite& s) {
  return std::lerp(s.cancellousBone + trabecularTexture(s.point), -40.0, s.shaft);
}

FootSubject::FootSubject() : LayeredSubject(footBoxMargin) {
  const Solid shape = m_anatomy.at("body");
  const auto sole = [](const Vec3& p) { return soleHeight(p) - p.z(); };
  // The web of the toes runs backward from the big toe to the little toe.
  const auto web = [](const Vec3& p) {
    return (p.y() - 208.0 + 0.40 * (p.x() + 15.0)) / std::hypot(1.0, 0.40);
  };
  m_body = {[shape, sole, web](const Vec3& p) {
              const double body = smoothIntersection(shape.distance(p), sole(p), 12.0);
              return smoothIntersection(body, web(p), 9.0);
            },
            shape.box};
  addBones();
  addSoftTissue();
}

double FootSubject::outlineDistance(const Vec3& p) const {
  double surface = smoothUnion(m_leg.distance(p), m_body.distance(p), 16.0);
  for (const Solid& toe : m_toes) {
    constexpr double blend = 5.0;
    if (contains(expandBox(toe.box, blend + 1.0), p))
      surface = smoothUnion(surface, toe.distance(p), blend);
  }
  return surface + 0.3 * valueNoise(p / 12.0, 261);
}

double FootSubject::skinDistance(const Vec3& p, double nearestBone) const {
  constexpr double skinOverBone = 4.2, skinOverTendon = 2.6, blend = 5.0; // mm
  double surface = smoothUnion(outlineDistance(p), nearestBone - skinOverBone, blend);
  for (const Solid& tendon : m_superficial)
    if (contains(expandBox(tendon.box, skinOverTendon + 2.0 * blend), p))
      surface = smoothUnion(surface, tendon.distance(p) - skinOverTendon, blend);
  return surface;
}

FootSite FootSubject::makeSite(const Vec3& p, double reach) const {
  FootSite s{};
  s.point = p;
  s.reach = reach;
  s.bones = m_bones.distances(p);
  const auto nearest = std::min_element(s.bones.begin(), s.bones.end());
  s.nearest = static_cast<std::size_t>(nearest - s.bones.begin());
  s.second = FootBones::maxDistance;
  for (std::size_t i = 0; i < s.bones.size(); ++i)
    if (i != s.nearest)
      s.second = std::min(s.second, s.bones[i]);
  s.surface = skinDistance(p, *nearest);
  if (s.surface > reach)
    return s;
  s.shaft = m_bones.shaftPosition(s.nearest, p);
  s.cancellousBone = m_bones.bones()[s.nearest].cancellousBone;
  s.fascia = s.surface + footFasciaDepth(p);
  return s;
}

std::int16_t FootSubject::acquire(double signal, const Vec3&, std::uint64_t voxel) const {
  const double noisy = std::clamp(signal + footNoise * normalNoise(voxel), -1024.0, 3071.0);
  return static_cast<std::int16_t>(std::lround(noisy));
}

void FootSubject::addShapes(std::uint8_t label, const Field& signal,
                            const std::vector<Solid>& shapes, double depth) {
  for (const Solid& shape : shapes)
    addLayer(label, signal, shape.box, makeIntersection(shape.distance, makeInset(depth)));
}

void FootSubject::addBones() {
  for (std::size_t i = 0; i < FootBones::count; ++i) {
    const FootBone& bone = m_bones.bones()[i];
    const auto label = addSegment(bone.id, bone.name, boneColor);
    const double endCortex = bone.cortex, shaftCortex = bone.shaftCortex;
    addLayer(label, footMarrowHu, bone.shape.box, [=](const FootSite& s) {
      const double thickness =
          i == s.nearest ? std::lerp(endCortex, shaftCortex, s.shaft) : endCortex;
      return s.bones[i] + thickness + 0.15 * valueNoise(s.point / 4.0, 276);
    });
    addLayer(label, footCortexHu, bone.shape.box, [i](const FootSite& s) { return s.bones[i]; });
  }
}

void FootSubject::addSoftTissue() {
  const Field underSkin = makeInset(footSkinThickness);
  const Field capsules = [](const FootSite& s) {
    constexpr double halfWidth = 2.3; // mm; capsules bridge joints up to twice as wide
    return 0.5 * (s.bones[s.nearest] + s.second) - halfWidth;
  };
  addLayer(addSegment("joints", "Joint cartilage and capsules", cartilageColor), makeConstant(85.0),
           everywhere, makeIntersection(capsules, underSkin));
  const std::vector<Solid> achilles = m_anatomy.at("achilles tendon");
  m_anatomy.at("extensor tendons").get_to(m_superficial);
  m_superficial.insert(m_superficial.end(), achilles.begin(), achilles.end());
  addShapes(addSegment("achilles_tendon", "Achilles tendon", tendonColor), footTendonHu, achilles,
            footSkinThickness + 0.5);
  const auto tendons = addSegment("tendons", "Tendons", tendonColor);
  for (const char* kind : {"extensor tendons", "flexor tendons"})
    addShapes(tendons, footTendonHu, m_anatomy.at(kind), footSkinThickness + 0.5);
  addShapes(addSegment("plantar_aponeurosis", "Plantar aponeurosis", tendonColor), footTendonHu,
            m_anatomy.at("plantar aponeurosis"), footSkinThickness + 2.0);
  addShapes(addSegment("vessels", "Vessels", vesselColor), makeConstant(45.0),
            m_anatomy.at("vessels"), footSkinThickness + 0.4);
  const auto muscles = addSegment("muscles", "Muscles", muscleColor);
  for (const Solid belly : m_anatomy.at("muscles"))
    addLayer(muscles, footMuscleHu, belly.box, [belly](const FootSite& s) {
      const double shape = belly.distance(s.point) + 0.6 * valueNoise(s.point / 6.0, 277);
      return std::max(shape, s.fascia);
    });
  addLayer(addSegment("fat", "Fat", fatColor), footFatHu, everywhere, underSkin);
  addLayer(addSegment("skin", "Skin", skinColor), makeConstant(35.0), everywhere, makeInset(0.0));
}

Phantom makeFootPhantom(const Size3& size, const PhantomProgress& progress) {
  constexpr Mat3 axes({0, 1, 0}, {-1, 0, 0}, {0, 0, 1}); // columns: anterior, left, superior
  Phantom phantom =
      paintPhantom(FootSubject(), makePhantomGrid(size, footFieldOfView, axes, footFieldCenter),
                   "foot", progress);
  addThresholdedBones(phantom);
  phantom.property = footProperty();
  phantom.towardViewer = {-0.9, 0.75, 0.75}; // medial, anterior, above
  return phantom;
}

} // namespace fenestra::core
