#include "phantoms/KneeSoftTissue.h"

#include "phantoms/Noise.h"

namespace fenestra {

namespace {

constexpr double muscleSquareness = 0.25;
constexpr double muscleCap = 5.0; ///< mm

Loft muscle(std::vector<LoftSection> sections) {
  return Loft(std::move(sections), muscleSquareness, muscleCap);
}

} // namespace

LegOutline::LegOutline()
    : m_loft({{-70, {0, -15.5}, {47, 44}},
              {-40, {0, -12.5}, {49, 47}},
              {-15, {0, -9.5}, {51, 49.5}},
              {8, {0, -5.5}, {53, 52.5}},
              {30, {0, -4}, {54, 54.5}},
              {55, {0, -4.5}, {55, 54}},
              {90, {0, -5}, {56, 54}}},
             0.2, 1.0) {}

double LegOutline::distance(const Vec3& p) const {
  const double kneecap = ellipsoidDistance(p, {2, 34, 38}, {25, 21, 28});
  const double tubercle = ellipsoidDistance(p, {2, 18, -30}, {14, 16, 26});
  const double leg = smoothUnion(smoothUnion(m_loft.distance(p), kneecap, 14.0), tubercle, 10.0);
  return leg + 0.5 * valueNoise(p / 14.0, 61);
}

double fasciaDepth(const Vec3& p) {
  // Thick at the rear and medially, thin over the kneecap, the tubercle and the shin.
  const double behind = smoothStep(20.0, -45.0, p.y());
  const double medial = smoothStep(10.0, -45.0, p.x()) * smoothStep(40.0, 10.0, p.y());
  return 3.4 + 3.0 * behind + 1.8 * medial + 0.7 * valueNoise(p / 16.0, 62);
}

std::vector<Loft> vastusMedialis() {
  return {muscle({{25, {-32, 17}, {5, 7}},
                  {36, {-31, 18}, {9, 13}},
                  {48, {-29, 20}, {14, 17}},
                  {62, {-27, 20}, {18, 20}},
                  {84, {-25, 19}, {22, 24}}})};
}

std::vector<Loft> vastusLateralis() {
  return {muscle({{40, {34, 18}, {5, 8}},
                  {52, {31, 20}, {11, 15}},
                  {65, {28, 20}, {17, 20}},
                  {84, {27, 18}, {21, 23}}})};
}

std::vector<Loft> quadricepsBelly() {
  return {muscle({{60, {0, 31}, {6, 2}}, {70, {0, 33}, {15, 5}}, {84, {0, 34}, {20, 8}}})};
}

std::vector<Loft> semimembranosus() {
  return {muscle({{2, {-31, -32}, {4, 4}},
                  {15, {-29, -35}, {6.5, 6}},
                  {32, {-27, -37}, {11, 9}},
                  {50, {-24, -37}, {15, 13}},
                  {84, {-22, -34}, {20, 18}}})};
}

std::vector<Loft> bicepsFemoris() {
  return {muscle({{-12, {39, -25}, {2.5, 3}},
                  {2, {39.5, -29}, {4, 6}},
                  {25, {37, -32}, {8, 9.5}},
                  {50, {31, -33}, {13, 12.5}},
                  {84, {26, -33}, {18, 17}}}),
          // The short head, along the shaft.
          muscle({{38, {27, -17}, {3, 4}}, {52, {23, -13}, {7, 8}}, {84, {19, -9}, {11, 11}}})};
}

std::vector<Loft> sartoriusAndGracilis() {
  return {
      muscle({{-28, {-41, -14}, {2.5, 6}},
              {0, {-45, -18}, {3.5, 9}},
              {40, {-46, -16}, {5, 12}},
              {84, {-45, -11}, {7, 14}}}),
      muscle(
          {{20, {-43.5, -33}, {2.5, 2.5}}, {45, {-41, -34}, {3.5, 5}}, {84, {-40, -31}, {6, 8}}})};
}

std::vector<Loft> medialGastrocnemius() {
  return {muscle({{-72, {-20, -41}, {23, 17}},
                  {-35, {-20, -43}, {22, 16}},
                  {-5, {-19, -44}, {18, 12.5}},
                  {18, {-17, -42}, {13, 8.5}},
                  {36, {-17, -36.5}, {8, 4.5}}})};
}

std::vector<Loft> lateralGastrocnemius() {
  return {muscle({{-72, {20, -41}, {21, 17}},
                  {-35, {20, -43}, {19, 15}},
                  {-5, {20, -44}, {16, 12}},
                  {15, {20, -42}, {12, 8.5}},
                  {34, {20, -36.5}, {7.5, 4.5}}})};
}

std::vector<Loft> popliteus() {
  return {muscle({{-68, {-7, -20}, {14, 7}},
                  {-45, {-3, -23}, {18, 7}},
                  {-25, {5, -29}, {19, 5.5}},
                  {-8, {17, -32}, {10, 4}},
                  {2, {28, -28}, {4, 3}}})};
}

std::vector<Loft> soleus() {
  return {muscle({{-72, {10, -29}, {30, 8}}, {-45, {18, -30}, {22, 6}}, {-24, {28, -29}, {9, 4}}})};
}

std::vector<Loft> tibialisAnterior() {
  return {muscle({{-72, {26, 4}, {17, 20}},
                  {-45, {28, 5}, {14, 17}},
                  {-28, {30, 6}, {10, 12}},
                  {-16, {31, 8}, {4, 5}}})};
}

std::vector<Loft> peroneus() {
  return {muscle({{-72, {41, -9}, {8, 13}}, {-45, {42, -9}, {7, 11}}, {-22, {42, -10}, {4, 6}}})};
}

Tube anteriorCruciateLigament() {
  return Tube({{{-1, 9, -1}, 3.6}, {{2.5, 1, 8}, 3.4}, {{7, -10, 18}, 3.6}, {{11, -19, 26}, 4.2}},
              {1.3, 1, 1});
}

Tube posteriorCruciateLigament() {
  return Tube(
      {{{1, -32, -14}, 4.2}, {{0, -30, -2}, 4.6}, {{-2, -22, 9}, 4.8}, {{-8, -4, 13}, 4.6}});
}

Tube medialCollateralLigament() {
  return Tube({{{-40, -3, 29}, 1.5},
               {{-41, -2, 14}, 1.5},
               {{-39.5, -1, 0}, 1.5},
               {{-36.5, 1, -18}, 1.4},
               {{-28, 3, -36}, 1.4},
               {{-20, 4, -54}, 1.2}},
              {1, 5, 1});
}

Tube lateralCollateralLigament() {
  return Tube(
      {{{40.5, -4, 27}, 2.3}, {{43, -9, 14}, 2.2}, {{43, -15, 0}, 2.2}, {{40, -20, -13}, 2.6}});
}

Tube patellarLigament() {
  // Fibres continue over the front of the kneecap, thinner.
  return Tube({{{2, 49.8, 54}, 1.2},
               {{2, 50.6, 40}, 1.2},
               {{2, 48, 25}, 1.9},
               {{2, 43.5, 12}, 2.4},
               {{2, 35.5, -8}, 2.5},
               {{2, 27.5, -30}, 2.6},
               {{2, 24, -40}, 2.2}},
              {5, 1, 1});
}

Tube quadricepsTendon() {
  return Tube({{{2, 45, 57}, 3.2}, {{1.5, 42, 66}, 3.3}, {{1, 40.5, 76}, 3.0}, {{1, 40, 86}, 2.2}},
              {4, 1, 1});
}

Tube iliotibialBand() {
  return Tube({{{46, 2, 86}, 1.2},
               {{46, 2, 50}, 1.2},
               {{44.5, 5, 22}, 1.2},
               {{41, 9, 0}, 1.3},
               {{33, 14, -14}, 1.6}},
              {1, 5, 1});
}

Tube semitendinosusTendon() {
  return Tube({{{-18, -45, 86}, 3.4},
               {{-20, -45, 50}, 2.6},
               {{-31, -41.5, 20}, 2.2},
               {{-38, -33, -5}, 2.1},
               {{-39, -18, -30}, 2.0},
               {{-30, 2, -50}, 1.6}});
}

Tube poplitealArtery() {
  return Tube({{{-7, -22, 86}, 3.0},
               {{-2, -29, 55}, 3.0},
               {{2, -36.5, 25}, 2.9},
               {{3, -38.5, -5}, 2.7},
               {{3, -36, -35}, 2.5},
               {{2, -34.5, -72}, 2.3}});
}

Tube poplitealVein() {
  return Tube({{{-2, -28, 86}, 3.6},
               {{3, -35.5, 55}, 3.8},
               {{6, -42, 25}, 3.6},
               {{3, -45, -5}, 3.2},
               {{-2, -39, -35}, 2.8},
               {{-3, -36, -72}, 2.4}});
}

Tube saphenousVein() {
  return Tube({{{-50, -16, 86}, 1.9},
               {{-49.5, -22, 40}, 2.0},
               {{-48.5, -24, 0}, 2.0},
               {{-45, -16, -35}, 1.9},
               {{-42, -12, -72}, 1.8}});
}

Tube tibialNerve() {
  return Tube({{{6, -43, 86}, 3.2},
               {{8, -46, 50}, 2.9},
               {{6, -49.5, 20}, 2.7},
               {{2, -50, -15}, 2.4},
               {{1, -41, -45}, 2.1},
               {{1, -38, -72}, 1.8}});
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

MeniscusRing medialMeniscus() {
  return {{-20.0, -4.5}, {18.0, 23.5}, 0.56, 0.62, 0.0};
}
MeniscusRing lateralMeniscus() {
  return {{20.0, -5.5}, {17.0, 19.0}, 0.50, 0.42, pi};
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
