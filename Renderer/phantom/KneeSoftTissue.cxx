#include "phantom/KneeSoftTissue.h"

#include "phantom/Noise.h"

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
  // Thick behind and medially, thin over the kneecap, the tubercle and the shin.
  const double behind = smoothStep(20.0, -45.0, p.y());
  const double medial = smoothStep(10.0, -45.0, p.x()) * smoothStep(40.0, 10.0, p.y());
  return 3.4 + 3.0 * behind + 1.8 * medial + 0.7 * valueNoise(p / 16.0, 62);
}

std::vector<Loft> vastusMedialis() {
  return {muscle({{27, {-31, 19}, {4, 6}},
                  {36, {-30, 20}, {7, 11}},
                  {48, {-28, 22}, {11, 14}},
                  {62, {-26, 22}, {15, 17}},
                  {84, {-24, 22}, {19, 19}}})};
}

std::vector<Loft> vastusLateralis() {
  return {muscle({{42, {32, 20}, {4, 6}},
                  {52, {30, 22}, {8, 12}},
                  {65, {27, 22}, {13, 16}},
                  {84, {25, 21}, {18, 19}}})};
}

std::vector<Loft> quadricepsBelly() {
  return {muscle({{60, {0, 31}, {6, 2}}, {70, {0, 33}, {15, 5}}, {84, {0, 34}, {20, 8}}})};
}

std::vector<Loft> semimembranosus() {
  return {muscle({{2, {-30, -31}, {3, 3}},
                  {15, {-29, -33}, {4.5, 4.5}},
                  {32, {-27, -35}, {8, 7}},
                  {50, {-23, -36}, {12, 11}},
                  {84, {-20, -34}, {17, 14}}})};
}

std::vector<Loft> bicepsFemoris() {
  return {muscle({{-12, {39, -25}, {2.5, 3}},
                  {2, {39.5, -28}, {3.5, 5}},
                  {25, {37, -31}, {6, 8}},
                  {50, {31, -33}, {10, 10.5}},
                  {84, {25, -33}, {14, 13}}})};
}

std::vector<Loft> sartoriusAndGracilis() {
  return {
      muscle({{-28, {-41, -14}, {2.5, 6}},
              {0, {-45, -19}, {3, 8}},
              {40, {-46, -17}, {3.5, 10}},
              {84, {-44, -12}, {4.5, 13}}}),
      muscle({{20, {-43.5, -33}, {2.5, 2.5}}, {45, {-41, -34}, {3, 4}}, {84, {-39, -34}, {4, 6}}})};
}

std::vector<Loft> medialGastrocnemius() {
  return {muscle({{-72, {-19, -41}, {19, 13}},
                  {-35, {-19, -43}, {17.5, 12.5}},
                  {-5, {-18, -44}, {15, 10.5}},
                  {18, {-17, -42}, {11, 7.5}},
                  {34, {-17, -37}, {7, 4}}})};
}

std::vector<Loft> lateralGastrocnemius() {
  return {muscle({{-72, {19, -41}, {18, 13}},
                  {-35, {20, -43}, {16, 12}},
                  {-5, {20, -44}, {13, 10}},
                  {15, {20, -42}, {10, 7}},
                  {32, {20, -37}, {6.5, 4}}})};
}

std::vector<Loft> popliteus() {
  return {muscle({{-68, {-6, -19}, {10, 6}},
                  {-45, {-3, -22}, {14, 6}},
                  {-25, {5, -29}, {17, 5}},
                  {-8, {17, -32}, {9, 3.5}},
                  {2, {28, -28}, {4, 3}}})};
}

std::vector<Loft> soleus() {
  return {
      muscle({{-72, {8, -27.5}, {25, 5}}, {-45, {16, -29}, {18, 4}}, {-24, {27, -28}, {7, 3}}})};
}

std::vector<Loft> tibialisAnterior() {
  return {muscle({{-72, {25, 4}, {13, 17}},
                  {-45, {27, 5}, {11, 14}},
                  {-28, {29, 7}, {7, 9}},
                  {-18, {29, 9}, {3, 4}}})};
}

std::vector<Loft> peroneus() {
  return {muscle({{-72, {41, -7}, {5.5, 10}}, {-45, {41.5, -8}, {5, 8}}, {-24, {41, -9}, {3, 5}}})};
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
  return Tube({{{-41.5, -3, 29}, 1.5},
               {{-42.5, -2, 14}, 1.5},
               {{-41, -1, 0}, 1.5},
               {{-37.5, 1, -18}, 1.4},
               {{-28, 3, -36}, 1.4},
               {{-20, 4, -54}, 1.2}},
              {1, 5, 1});
}

Tube lateralCollateralLigament() {
  return Tube(
      {{{40.5, -4, 27}, 2.3}, {{43, -9, 14}, 2.2}, {{43, -15, 0}, 2.2}, {{40, -20, -13}, 2.6}});
}

Tube patellarLigament() {
  // Its fibres run on over the front of the kneecap, thinner.
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
  return Tube({{{-24, -49, 86}, 3.6},
               {{-27, -49, 50}, 2.6},
               {{-33, -46, 20}, 2.2},
               {{-40, -36, -5}, 2.1},
               {{-41, -18, -30}, 2.0},
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
  // The horns are slimmer than the body and end round.
  const double horns = smoothStep(openingAngle + 0.9, openingAngle, turn);
  const double inner = std::lerp(innerShare, 0.5 * (1.0 + innerShare), horns);
  const double ring = std::max(share - 1.0, inner - share) * scale;
  const double ends = (openingAngle - turn) * share * scale;
  // From the thin inner edge the wedge grows to 6 mm at the rim.
  const double height = 0.6 + 5.4 * std::clamp((share - inner) / (1.0 - inner), 0.0, 1.0);
  const double faces = std::max(p.z() - height, -3.6 - p.z());
  return smoothIntersection(smoothIntersection(ring, ends, 3.0), faces, 2.0);
}

MeniscusRing medialMeniscus() {
  return {{-20.5, -4.5}, {18.5, 23.5}, 0.56, 0.62, 0.0};
}
MeniscusRing lateralMeniscus() {
  return {{20.5, -5.5}, {17.5, 19.0}, 0.50, 0.42, pi};
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
