#include "phantoms/KneeSignal.h"

#include "phantoms/Noise.h"
#include "phantoms/Shapes.h"

namespace fenestra::core {

namespace {

/// 1 on thin, crumpled sheets with gaps, about `size` mm apart; 0 elsewhere.
double septa(const Vec3& p, const Vec3& size, double thickness, std::uint64_t seed) {
  const Vec3 bend{valueNoise(p / 5.0, seed + 100), valueNoise(p / 5.0, seed + 101),
                  valueNoise(p / 5.0, seed + 102)};
  const double level = std::abs(valueNoise((p + 2.0 * bend).cwiseQuotient(size), seed));
  const double sheet = 1.0 - smoothStep(0.2 * thickness, thickness, level);
  return sheet == 0.0 ? 0.0 : sheet * smoothStep(-0.5, 0.5, valueNoise(p / 9.0, seed + 103));
}

/// Growth plate scars: dark, slightly wavy sheets.
double physis(const Vec3& p) {
  const double wave = 1.6 * valueNoise(p / 9.0, 77) + 0.004 * (p.x() * p.x() - 500.0);
  const double femoral = std::abs(p.z() - 35.0 + wave + 0.12 * p.y());
  const double tibial = std::abs(p.z() + 17.0 + wave - 0.05 * p.y());
  const double kneecap = smoothStep(28.0, 31.0, p.y()); // the kneecap has no growth plate
  return (1.0 - kneecap) * (1.0 - smoothStep(0.3, 1.1, std::min(femoral, tibial)));
}

} // namespace

double muscleSignal(const Vec3& p) {
  const double fibers = 20.0 * valueNoise(p.cwiseQuotient(Vec3{1.2, 1.2, 10.0}), 71);
  const double bundles = 16.0 * valueNoise(p.cwiseQuotient(Vec3{4.0, 4.0, 20.0}), 72);
  const double fat = 0.5 * septa(p, {5.5, 5.5, 25.0}, 0.12, 73);
  return std::lerp(350.0 + fibers + bundles, 780.0, fat);
}

double fatSignal(const Vec3& p, double strands) {
  const double lobules = 20.0 * valueNoise(p / 3.0, 75) + 18.0 * valueNoise(p / 9.0, 74);
  return 860.0 + lobules - strands * septa(p, {6.0, 6.0, 8.0}, 0.16, 76);
}

double marrowSignal(const Vec3& p) {
  // Trabeculae run mainly along the limb's axis.
  const double trabeculae =
      38.0 * valueNoise(p.cwiseQuotient(Vec3{0.9, 0.9, 2.2}), 78) + 22.0 * valueNoise(p / 2.5, 79);
  const double patches = 28.0 * valueNoise(p / 12.0, 80);
  return 815.0 + trabeculae + patches - 150.0 * physis(p);
}

double nerveSignal(const Vec3& p) {
  return 420.0 + 60.0 * valueNoise(p.cwiseQuotient(Vec3{0.9, 0.9, 8.0}), 81);
}

double meniscusSignal(const Vec3& p) {
  return 105.0 + 18.0 * valueNoise(p / 2.0, 82);
}

double ligamentSignal(const Vec3& p) {
  return 112.0 + 28.0 * valueNoise(p / 1.5, 83);
}

double cartilageSignal(const Vec3& p) {
  return 520.0 + 16.0 * valueNoise(p / 2.5, 84);
}

double biasField(const Vec3& p) {
  const double coil = 0.06 * p.y() / 60.0 + 0.03 * std::cos((p.z() - 10.0) / 28.0);
  return 1.0 + coil + 0.05 * valueNoise(p / 55.0, 85);
}

} // namespace fenestra::core
