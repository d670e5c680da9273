#include "phantoms/KneeBones.h"

#include "phantoms/Anatomy.h"
#include "phantoms/Noise.h"

namespace fenestra::core {

namespace {

constexpr double axisY = -6.0, axisZ = 24.0; ///< transcondylar axis, along x
constexpr double grooveX = 1.5;              ///< bottom of the trochlear groove
constexpr double notchX = 0.5;               ///< middle of the intercondylar notch

/// Sagittal outline of the distal femur around the transcondylar axis: a spiral whose radius of
/// curvature decreases from nearly 40 mm at the trochlea to 20 mm at the rear.
struct ProfileNode {
  double degrees, radius;
};
constexpr ProfileNode profileNodes[] = {
    {-180, 25.4}, {-150, 24.6}, {-125, 23.0}, {-108, 21.9}, {-90, 21.5}, {-70, 22.6},
    {-50, 25.2},  {-32, 28.8},  {-15, 32.3},  {0, 34.8},    {20, 37.2},  {36, 39.0},
    {60, 32.0},   {90, 23.0},   {120, 23.5},  {150, 25.8},  {180, 25.4}};

double hermite(double a, double b, double slopeA, double slopeB, double width, double t) {
  const double u = 1.0 - t;
  return a * u * u * (1.0 + 2.0 * t) + b * t * t * (3.0 - 2.0 * t) +
         width * t * u * (slopeA * u - slopeB * t);
}

double profileAtDegrees(double degrees) {
  constexpr int last = static_cast<int>(std::size(profileNodes)) - 1;
  // The outline is closed: node 0 equals node `last`, one turn earlier.
  const auto node = [](int i) {
    const int turn = i < 0 ? -1 : i > last ? 1 : 0;
    const ProfileNode& n = profileNodes[i - turn * last];
    return ProfileNode{n.degrees + 360.0 * turn, n.radius};
  };
  int i = 0;
  while (i + 1 < last && degrees > profileNodes[i + 1].degrees)
    ++i;
  const auto slope = [&](int j) {
    return (node(j + 1).radius - node(j - 1).radius) / (node(j + 1).degrees - node(j - 1).degrees);
  };
  const double width = node(i + 1).degrees - node(i).degrees;
  return hermite(node(i).radius, node(i + 1).radius, slope(i), slope(i + 1), width,
                 (degrees - node(i).degrees) / width);
}

/// x of the medial and lateral walls of the distal femur near a point, mm.
struct Walls {
  double medial, lateral;
};
Walls computeWalls(const Vec3& p) {
  const double distal = std::max(0.0, 20.0 - p.z());
  const double narrowing = 0.003 * distal * distal;
  const double back = p.y() < 0.0 ? 0.0035 * p.y() * p.y() : 0.0;
  const double front = p.y() > 0.0 ? p.y() * p.y() : 0.0;
  return {-38.5 + narrowing + back + 0.009 * front, 38.2 - narrowing - back - 0.0065 * front};
}

/// Intercondylar notch, open to the rear and below; its roof rises backward (Blumensaat's line).
double notchField(const Vec3& p) {
  const double roof = ((p.y() - 8.0) * 28.0 + (p.z() - 8.5) * 24.0) / std::hypot(28.0, 24.0);
  const double sides = std::abs(p.x() - notchX) - 9.2 - 0.05 * std::max(0.0, -10.0 - p.y());
  return smoothIntersection(roof, sides, 9.0);
}

/// Converts a field with a slope near 1 into a distance, accurate to first order (Taubin 1994,
/// "Distance Approximations for Rasterizing Implicit Curves").
template <typename Field>
double firstOrderDistance(const Field& field, const Vec3& p) {
  constexpr double step = 0.05;
  const double value = field(p);
  if (std::abs(value) > 4.0) // far away, where the field has kinks and accuracy does not matter
    return value;
  const Vec3 slope{field(p + Vec3{step, 0, 0}) - value, field(p + Vec3{0, step, 0}) - value,
                   field(p + Vec3{0, 0, step}) - value};
  return value / std::clamp(slope.norm() / step, 0.3, 2.0);
}

/// Weight of the trochlea: 1 on it, 0 on the bearing and rear parts of the condyles.
double trochleaWeight(double angle, double distalEnd, double frontEnd) {
  return smoothStep(distalEnd, frontEnd, angle) * (1.0 - smoothStep(1.5, 2.5, angle));
}

/// Height of the tibia's upper surface, mm: a concave medial and a convex lateral plateau, sloping
/// down backward, and the two spines of the eminence.
double plateauHeight(const Vec3& p) {
  const auto hill = [&](double x, double y, double rx, double ry) {
    return std::exp(-std::pow((p.x() - x) / rx, 2) - std::pow((p.y() - y) / ry, 2));
  };
  const double slope = 0.05 * (p.y() + 4.0);
  const double bowls = -1.3 * hill(-21.0, -4.0, 10.0, 14.0) + 0.5 * hill(21.0, -6.0, 9.0, 9.0);
  const double spines = 7.5 * hill(-4.5, -3.0, 3.6, 7.0) + 6.5 * hill(5.5, -5.0, 3.4, 6.0);
  const double front = -3.0 * smoothStep(10.0, 24.0, p.y());
  return -2.6 + slope + bowls + spines + front;
}

/// Adds a bone's surface noise to the distance from it. More than `reach` + 6 mm away, where it
/// neither moves the surface nor affects a layer of the joint, it is omitted.
double roughen(double distance, const Vec3& p, std::uint64_t seed, double reach) {
  if (std::abs(distance) > reach + 6.0)
    return distance;
  return distance + (0.35 * valueNoise(p / 7.0, seed) + 0.12 * valueNoise(p / 2.5, seed + 1));
}

} // namespace

KneeBones::KneeBones() {
  const Anatomy anatomy = loadAnatomy("knee");
  anatomy.at("femoral shaft").get_to(m_femoralShaft);
  anatomy.at("tibial shaft").get_to(m_tibialShaft);
  anatomy.at("fibula").get_to(m_fibula);
  anatomy.at("patella").get_to(m_patellaBody);
  for (int i = 0; i <= profileSteps; ++i)
    m_profile[static_cast<std::size_t>(i)] = profileAtDegrees(-180.0 + i * 360.0 / profileSteps);
}

double KneeBones::profile(double angle) const {
  const double x = (angle / pi + 1.0) * (profileSteps / 2.0);
  const int i = std::clamp(static_cast<int>(x), 0, profileSteps - 1);
  const auto at = static_cast<std::size_t>(i);
  return std::lerp(m_profile[at], m_profile[at + 1], x - i);
}

/// Condyles and trochlea as one surface around the transcondylar axis. At the rear and below, each
/// condyle is convex across; in front, the groove lies between a high lateral and a lower medial
/// facet.
double KneeBones::condyleField(const Vec3& p) const {
  const double y = p.y() - axisY, z = p.z() - axisZ;
  const double angle = std::atan2(z, y);
  const double medial = std::abs(p.x() - (-23.5 + 0.10 * p.y()));
  const double lateral = std::abs(p.x() - (23.5 - 0.02 * p.y()));
  const double aside = smoothUnion(medial, lateral, 8.0);
  const double rear = smoothStep(2.4, 3.0, std::abs(angle - 0.3));
  const double crown = -aside * aside * (1.0 + 0.7 * rear) / (2.0 * 26.0);
  const double groove = -5.5 * std::exp(-std::pow((p.x() - grooveX) / 9.0, 2));
  const double facets = 2.2 * smoothStep(3.0, 17.0, p.x()) - 0.6 * smoothStep(3.0, 15.0, -p.x());
  const double outer = std::max(0.0, std::abs(p.x() - 3.0) - 18.0);
  const double anterior = trochleaWeight(angle, -1.35, -0.45);
  const double relief = std::lerp(crown, groove + facets - outer * outer / 20.0, anterior);
  return std::hypot(y, z) - profile(angle) - relief;
}

double KneeBones::femurField(const Vec3& p) const {
  const Walls wall = computeWalls(p);
  const double sides = std::max(wall.medial - p.x(), p.x() - wall.lateral);
  double bone = smoothIntersection(condyleField(p), sides, 9.0);
  const double medialEpicondyle = ellipsoidDistance(p, {-35, -3, 25}, {5.5, 11, 11});
  const double lateralEpicondyle = ellipsoidDistance(p, {35, -5, 24}, {5, 9, 9});
  bone = smoothUnion(bone, std::min(medialEpicondyle, lateralEpicondyle), 8.0);
  bone = smoothUnion(bone, m_femoralShaft.distance(p), 7.0);
  return smoothDifference(bone, notchField(p), 8.0);
}

double KneeBones::tibiaField(const Vec3& p) const {
  const double tuberosity = ellipsoidDistance(p, {2, 19, -37}, {9, 6.5, 12});
  const double medial = ellipsoidDistance(p, {-19.5, -4.5, -8}, {17.5, 26, 15});
  const double lateral = ellipsoidDistance(p, {19.5, -5.5, -8}, {17, 23, 14});
  const double condyles = std::min(medial, lateral);
  const double shaft =
      smoothUnion(smoothUnion(m_tibialShaft.distance(p), tuberosity, 8.0), condyles, 12.0);
  // The outline recedes between the rear parts of the condyles (groove of the PCL).
  const double rearGroove = ellipsoidDistance(p, {0, -34, -6}, {11, 11, 20});
  const double sides = smoothDifference(shaft, rearGroove, 6.0);
  constexpr double blend = 3.5, lowestPlateau = -10.0; // mm
  if (p.z() - lowestPlateau + blend < sides)           // far below the plateau
    return sides;
  return smoothIntersection(sides, p.z() - plateauHeight(p), blend);
}

/// Rounded triangle in front; at the rear, two facets meet in a ridge that glides in the groove.
double KneeBones::patellaField(const Vec3& p) const {
  const double across = p.x() - 2.0;
  const double ridge = std::sqrt(across * across + 9.0) - 3.0;
  const double slope = across > 0.0 ? 0.30 : 0.40;
  const double apex = 0.35 * std::max(0.0, 30.0 - p.z()); // the lower quarter has no facets
  const double facets = 32.0 + slope * ridge + apex - p.y();
  const double front = std::max(0.0, std::abs(across) - 6.0);
  const double dome = p.y() - 50.0 + 0.010 * front * front + 0.004 * std::pow(p.z() - 40.0, 2);
  return smoothIntersection(smoothIntersection(m_patellaBody.distance(p), facets, 4.0), dome, 5.0);
}

double KneeBones::distance(const Box& box, double (KneeBones::*field)(const Vec3&) const,
                           std::uint64_t seed, const Vec3& point, double reach) const {
  if (!contains(expandBox(box, maxDistance), point))
    return maxDistance;
  return roughen(firstOrderDistance([&](const Vec3& p) { return (this->*field)(p); }, point), point,
                 seed, reach);
}

double KneeBones::femur(const Vec3& point, double reach) const {
  return distance({{-43, -36, 0}, {43, 36, 82}}, &KneeBones::femurField, 11, point, reach);
}

double KneeBones::tibia(const Vec3& point, double reach) const {
  return distance({{-41, -33, -66}, {41, 28, 8}}, &KneeBones::tibiaField, 21, point, reach);
}

double KneeBones::fibula(const Vec3& point, double reach) const {
  return contains(expandBox(m_fibula.box, maxDistance), point)
             ? roughen(m_fibula.distance(point), point, 31, reach)
             : maxDistance;
}

double KneeBones::patella(const Vec3& point, double reach) const {
  return distance(m_patellaBody.box, &KneeBones::patellaField, 41, point, reach);
}

Vec3 KneeBones::femoralSurface(double x, double angle) const {
  const Vec3 outward{0.0, std::cos(angle), std::sin(angle)};
  double radius = profile(angle);
  for (int i = 0; i < 20; ++i) // the field's slope along the radius is near 1
    radius -= femur(Vec3{x, axisY, axisZ} + radius * outward);
  return Vec3{x, axisY, axisZ} + radius * outward;
}

namespace {

/// Remaining fraction of the cartilage at a lesion: 1 outside, 1 - depth on its floor; steep walls.
double lesionFactor(const CartilageLesion& lesion, const Vec3& p) {
  const double y = p.y() - axisY, z = p.z() - axisZ;
  const double along = std::hypot(y, z) * (std::atan2(z, y) - lesion.angle);
  const double ragged = 0.5 * valueNoise(p / 2.0, 51);
  const double edgeDistance = std::hypot(p.x() - lesion.x, along) + ragged - 0.5 * lesion.diameter;
  return 1.0 - lesion.depth * (1.0 - smoothStep(-0.35, 0.35, edgeDistance));
}

/// Thickness at `margin` mm inside the cartilage's edge: rises from 0 to `thickness`.
double taperThickness(double thickness, double margin) {
  return thickness * smoothStep(-1.0, 3.2, margin);
}

} // namespace

double KneeBones::intactFemoralCartilage(const Vec3& p) const {
  const double y = p.y() - axisY, z = p.z() - axisZ;
  const double angle = std::atan2(z, y);
  const double rear = smoothStep(5.0, -20.0, p.y());
  const double front = 45.0 - 0.005 * std::pow(p.x() - 2.0, 2);
  const double top = std::lerp(front, 34.0, rear) - p.z();
  const Walls wall = computeWalls(p);
  const double sides = std::min(wall.lateral - p.x(), p.x() - wall.medial) - 2.5 - 2.0 * rear;
  const double corners = smoothUnion(top, sides, std::lerp(3.0, 9.0, rear));
  const double margin = smoothUnion(corners, notchField(p) - 2.3, 4.0);
  if (margin <= 0.0)
    return 0.0;
  const double trochlea = trochleaWeight(angle, -0.9, 0.1);
  const double bearing = std::exp(-std::pow((angle + 1.35) / 0.6, 2));
  const double thickness = 1.75 + 0.65 * trochlea + 0.55 * bearing + 0.22 * valueNoise(p / 9.0, 52);
  return taperThickness(std::clamp(thickness, 1.4, 2.65), margin);
}

double KneeBones::femoralCartilage(const Vec3& p) const {
  return applyLesions(intactFemoralCartilage(p), p);
}

double KneeBones::applyLesions(double intact, const Vec3& p) const {
  if (intact == 0.0)
    return 0.0;
  return intact * lesionFactor(fullThicknessLesion, p) * lesionFactor(partialThicknessLesion, p);
}

double KneeBones::tibialCartilage(const Vec3& p) const {
  if (std::abs(p.z()) > maxDistance)
    return 0.0;
  const auto oval = [&](double x, double y, double rx, double ry) {
    return -ellipsoidDistance({p.x(), p.y(), 0}, {x, y, 0}, {rx, ry, 1});
  };
  const double medial = oval(-20.5, -4.5, 15.5, 22.0);
  const double lateral = oval(20.5, -6.0, 14.5, 18.5);
  const double margin = std::max(medial, lateral);
  if (margin <= 0.0)
    return 0.0;
  const double center = smoothStep(3.0, 14.0, margin);
  const double thickness = 1.7 + 0.75 * center + 0.2 * valueNoise(p / 8.0, 53);
  return taperThickness(std::clamp(thickness, 1.4, 2.65), margin);
}

double KneeBones::patellarCartilage(const Vec3& p) const {
  const double across = (p.x() - 2.0) / 21.0, up = (p.z() - 43.0) / 15.5;
  const double margin = 17.0 * (1.0 - std::sqrt(across * across + up * up));
  if (margin <= 0.0 || p.y() > 41.0)
    return 0.0;
  const double ridge = std::exp(-std::pow((p.x() - 2.0) / 7.0, 2));
  const double thickness = 2.0 + 0.5 * ridge + 0.2 * valueNoise(p / 8.0, 54);
  return taperThickness(std::clamp(thickness, 1.4, 2.65), margin);
}

} // namespace fenestra::core
