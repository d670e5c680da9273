#include "phantoms/KneeSoftTissue.h"

#include "phantoms/Noise.h"

namespace fenestra {

double legOutline(const Solid& trunk, const Vec3& p) {
  const double kneecap = ellipsoidDistance(p, {2, 34, 38}, {25, 21, 28});
  const double tubercle = ellipsoidDistance(p, {2, 18, -30}, {14, 16, 26});
  const double leg = smoothUnion(smoothUnion(trunk.distance(p), kneecap, 14.0), tubercle, 10.0);
  return leg + 0.5 * valueNoise(p / 14.0, 61);
}

double fasciaDepth(const Vec3& p) {
  // Thick at the rear and medially, thin over the kneecap, the tubercle and the shin.
  const double behind = smoothStep(20.0, -45.0, p.y());
  const double medial = smoothStep(10.0, -45.0, p.x()) * smoothStep(40.0, 10.0, p.y());
  return 3.4 + 3.0 * behind + 1.8 * medial + 0.7 * valueNoise(p / 16.0, 62);
}

double MeniscusRing::distance(const Vec3& p) const {
  const Vec2 offset = p.head<2>() - center;
  const Vec2 scaled = offset.cwiseQuotient(outerRadii);
  const double share = scaled.norm();
  const double scale = outerRadii.mean();
  double turn = std::atan2(scaled.y(), scaled.x()) - opening;
  turn = std::abs(std::remainder(turn, 2.0 * pi));
  // The horns are slimmer than the body, with round ends.
  const double horns = smoothStep(openingAngle + 0.9, openingAngle, turn);
  const double inner = std::lerp(innerShare, 0.5 * (1.0 + innerShare), horns);
  const double ring = std::max(share - 1.0, inner - share) * scale;
  const double ends = (openingAngle - turn) * share * scale;
  // The wedge grows from the thin inner edge to 6 mm at the rim.
  const double height = 0.6 + 5.4 * std::clamp((share - inner) / (1.0 - inner), 0.0, 1.0);
  const double faces = std::max(p.z() - height, -3.6 - p.z());
  return smoothIntersection(smoothIntersection(ring, ends, 3.0), faces, 2.0);
}

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

double suprapatellarRecess(const Vec3& p) {
  const double sheet = ellipsoidDistance(p, {1, 31.5, 60}, {17, 2.4, 14});
  return sheet + 0.5 * valueNoise(p / 6.0, 63);
}

} // namespace fenestra
