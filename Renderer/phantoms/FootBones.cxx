#include "phantoms/FootBones.h"

#include "phantoms/FootRays.h"
#include "phantoms/Noise.h"

namespace fenestra {

namespace {

const Vec3 superior = Vec3::UnitZ();
constexpr double jointBlend = 1.5; ///< mm; rounding of a joint face's rim

Solid calcaneusShape() {
  const Vec3 heel(-2.0, 12.0, 29.0), front(15.0, 82.0, 41.0);
  const Loft body({{0.0, {0, -1}, {9, 15}},
                   {5.0, {0, 0}, {12, 19}},
                   {14.0, {0, 0}, {13.5, 21}},
                   {28.0, {0, 0.5}, {12.5, 18.5}},
                   {42.0, {0, 0}, {13, 17}},
                   {56.0, {0, 0}, {13, 14.5}},
                   {68.0, {0, 0}, {12, 12.5}},
                   {73.0, {0, 0}, {11.5, 12}}},
                  0.35, 7.0);
  const Solid medialProcess = ellipsoid({-7, 20, 15}, {8, 11, 7});
  const Solid posteriorFacet = ellipsoid({4, 51, 48}, {13, 15, 11});
  const Solid sustentaculum =
      block(toShape({-13, 63, 47}, {0.2, 1, 0.1}, superior), {9, 4.5, 11}, 4);
  Solid shape = placed(toShape(heel, front - heel, superior), body);
  shape = unite(shape, medialProcess, 6.0);
  shape = unite(shape, posteriorFacet, 7.0);
  return unite(shape, sustentaculum, 6.0);
}

/// The trochlea is the upper half of a cylinder; the head is a ball, anterior and medial to the
/// trochlea.
Solid talusShape() {
  const Vec3 axis(1.0, 0.05, 0.0);
  const Loft trochlea({{-15.5, {0, 0}, {20.5, 20.5}},
                       {-8.0, {0, 0}, {20.5, 20.5}},
                       {0.0, {0, 0}, {19.6, 19.6}}, // a shallow groove between its two rims
                       {8.0, {0, 0}, {20.5, 20.5}},
                       {15.5, {0, 0}, {20.5, 20.5}}},
                      0.0, 4.0);
  const Solid wheel = placed(toShape({-1, 61, 65}, axis, superior), trochlea);
  const Solid above = {[](const Vec3& p) { return 53.0 - p.z(); },
                       {Vec3(-60, 0, 53), Vec3(60, 200, 200)}};
  const Tube neck({{{-4, 74, 64}, 13.0}, {{-10, 87, 60}, 11.5}, {{-15, 95, 57}, 11.0}});
  const Solid posterior = ellipsoid({-1, 41, 59}, {9, 7, 6});
  const Solid lateral = ellipsoid({14, 62, 58}, {6, 9, 8});
  Solid shape = intersect(wheel, above, 6.0);
  shape = unite(shape, {[neck](const Vec3& p) { return neck.distance(p); }, neck.box()}, 6.0);
  shape = unite(shape, ellipsoid({-15.5, 96, 56}, {14, 11.5, 12.5}), 4.0);
  shape = unite(shape, posterior, 6.0);
  return unite(shape, lateral, 5.0);
}

Solid tibiaShape() {
  const Loft shaft({{76, {-3, 60}, {19, 17.5}},
                    {80, {-3, 60}, {20, 19}},
                    {88, {-3, 59}, {20.5, 19.5}},
                    {98, {-3, 57.5}, {18.5, 17.5}},
                    {112, {-4, 55.5}, {15, 15}},
                    {130, {-5, 54}, {13, 14}},
                    {160, {-5, 53}, {12.5, 14}}},
                   0.3, 4.0);
  const Loft malleolus({{60, {-23, 63}, {3.5, 6}},
                        {65, {-23, 63}, {4.8, 9}},
                        {74, {-22.5, 62.5}, {6, 12}},
                        {86, {-20, 61}, {7, 14}},
                        {96, {-15, 59}, {7, 13}}},
                       0.2, 5.0);
  const Affine world = Affine::Identity();
  return unite(placed(world, shaft), placed(world, malleolus), 6.0);
}

Solid fibulaShape() {
  const Loft loft({{52, {21.5, 56}, {4, 5}},
                   {57, {22.5, 56}, {6, 8}},
                   {66, {23.5, 55}, {7, 10}},
                   {76, {23.5, 53}, {7, 9.5}},
                   {88, {22.5, 51}, {6, 7.5}},
                   {104, {22, 49}, {5.5, 6}},
                   {160, {21, 47}, {6, 6.5}}},
                  0.25, 5.0);
  return placed(Affine::Identity(), loft);
}

/// Boat-shaped; the talus's head cuts the hollow rear.
Solid navicularShape() {
  const Affine frame = toShape({-19, 106, 55}, {-0.28, 1.0, -0.12}, {-0.35, 0.0, 1.0});
  const Solid body = block(frame, {17.5, 12.5, 8.5}, 7.0);
  return unite(body, ellipsoid({-36, 103, 47}, {6.5, 8, 6.5}), 6.0);
}

Solid cuboidShape() {
  const Solid body =
      block(toShape({19, 102, 37}, {0.12, 1.0, -0.28}, {0.35, 0.0, 1.0}), {12.5, 12, 18.8}, 8.5);
  return unite(body, ellipsoid({16, 96, 26}, {9, 6, 6}),
               5.0); // ridge above the peroneal groove
}

} // namespace

FootBones::FootBones() {
  m_bones.reserve(count);
  addHindfoot();
  addLegStumps();
  addMidfoot();
  addRays();
}

void FootBones::add(FootBone bone, const std::vector<std::string>& neighbours) {
  for (const std::string& id : neighbours)
    for (std::size_t i = 0; i < m_bones.size(); ++i)
      if (m_bones[i].id == id)
        bone.neighbours.push_back(i);
  m_bones.push_back(std::move(bone));
}

void FootBones::addHindfoot() {
  FootBone calcaneus{"calcaneus", "Calcaneus", calcaneusShape(), {}};
  calcaneus.cortex = 1.2;
  calcaneus.spongiosa = 260.0;
  add(calcaneus, {});
  FootBone talus{"talus", "Talus", talusShape(), {}};
  talus.cortex = 1.3;
  talus.spongiosa = 380.0;
  add(talus, {"calcaneus"});
}

void FootBones::addLegStumps() {
  FootBone tibia{"tibia", "Tibia", tibiaShape(), {}};
  tibia.gap = 2.6; // two cartilages in the ankle
  tibia.base = {-3, 60, 78};
  tibia.head = {-6, 52, 250}; // most of the shaft is outside the field of view
  tibia.cortex = 1.2;
  tibia.shaftCortex = 4.0;
  add(tibia, {"talus", "calcaneus"});
  FootBone fibula{"fibula", "Fibula", fibulaShape(), {}};
  fibula.base = {22, 56, 56};
  fibula.head = {21, 45, 240};
  fibula.cortex = 1.0;
  fibula.shaftCortex = 3.0;
  add(fibula, {"talus", "tibia", "calcaneus"});
}

void FootBones::addMidfoot() {
  const auto tarsal = [this](const char* id, const char* name, const Solid& shape,
                             const std::vector<std::string>& neighbours) {
    FootBone bone{id, name, shape, {}};
    bone.gap = 1.8;
    bone.cortex = 1.1;
    add(bone, neighbours);
  };
  tarsal("navicular", "Navicular", navicularShape(), {"talus", "calcaneus"});
  tarsal("medial_cuneiform", "Medial cuneiform",
         block(toShape({-29, 125, 47}, {-0.08, 1, -0.12}, {0.15, 0, 1}), {8.8, 14, 13.3}, 7.0),
         {"navicular"});
  tarsal("intermediate_cuneiform", "Intermediate cuneiform",
         block(toShape({-12.5, 122, 57}, {0, 1, -0.15}, {0.1, 0, 1}), {7.4, 9.3, 9.7}, 5.5),
         {"navicular", "medial_cuneiform"});
  tarsal("lateral_cuneiform", "Lateral cuneiform",
         block(toShape({3, 121, 52}, {0.05, 1, -0.2}, {0.25, 0, 1}), {7.7, 10.3, 12.2}, 6.0),
         {"navicular", "intermediate_cuneiform"});
  tarsal("cuboid", "Cuboid", cuboidShape(),
         {"calcaneus", "navicular", "lateral_cuneiform", "talus"});
}

void FootBones::addRays() {
  for (const LongBone& ray : footRays()) {
    FootBone bone{ray.id, ray.name, ray.shape(), {}};
    bone.gap = 1.7;
    bone.base = ray.base;
    bone.head = ray.head;
    bone.cortex = ray.cortex;
    bone.shaftCortex = ray.shaftCortex;
    bone.spongiosa = ray.spongiosa;
    add(bone, ray.neighbours);
  }
}

FootBones::Distances FootBones::distances(const Vec3& p) const {
  Distances distances;
  for (std::size_t i = 0; i < m_bones.size(); ++i) {
    const FootBone& bone = m_bones[i];
    distances[i] = beyond;
    if (!contains(expanded(bone.shape.box, beyond), p))
      continue;
    double distance = bone.shape.distance(p);
    for (const std::size_t neighbour : bone.neighbours)
      distance = smoothDifference(distance, distances[neighbour] - bone.gap, jointBlend);
    const double roughness =
        0.25 * valueNoise(p / 6.0, 200 + i) + 0.1 * valueNoise(p / 2.3, 230 + i);
    distances[i] = std::min(distance + roughness, beyond);
  }
  return distances;
}

double FootBones::shaft(std::size_t bone, const Vec3& p) const {
  const Vec3 axis = m_bones[bone].head - m_bones[bone].base;
  if (axis.isZero())
    return 0.0;
  const double t = (p - m_bones[bone].base).dot(axis) / axis.squaredNorm();
  return smoothStep(0.12, 0.38, t) * smoothStep(0.92, 0.68, t);
}

} // namespace fenestra
