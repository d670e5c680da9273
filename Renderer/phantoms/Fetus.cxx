#include "phantoms/Fetus.h"

#include "phantoms/FetusHead.h"
#include "phantoms/Noise.h"
#include "phantoms/Painter.h"

#include <memory>

namespace fenestra {

namespace {

const Vec3 fetusFieldOfView{112.0, 112.0, 112.0}; ///< mm along the voxel axes
const Vec3 fetusFieldCenter{0.0, 14.0, -8.0};     ///< world

enum class FetusTissue { skin, inside, cord, wall, fluid };

struct FetusSite {
  Vec3 point;
  double surface; ///< mm to the subject's outside, which is not in view
};

using FetusLayer = PaintLayer<FetusSite, FetusTissue>;

/// Echo strength, 0 to 255; larger for tissue that scatters more.
double echo(FetusTissue tissue, const Vec3& p) {
  switch (tissue) {
  case FetusTissue::skin:
    return 165.0;
  case FetusTissue::inside:
    return 92.0 + 16.0 * valueNoise(p / 5.0, 11);
  case FetusTissue::cord:
    return 130.0;
  case FetusTissue::wall:
    return 118.0 + 22.0 * valueNoise(p / 6.0, 12);
  case FetusTissue::fluid:
    break;
  }
  return 6.0;
}

/// The fetus in its fluid, a Subject of Painter.
class FetusSubject {
public:
  using Site = FetusSite;
  using Layer = FetusLayer;
  static constexpr double background = 6.0; ///< fluid

  FetusSubject() {
    const Solid head = fetusHead();
    const Solid hand = fetusHand();
    constexpr double skin = 2.2; // mm
    add(1, FetusTissue::inside, shrunken(head, skin));
    add(1, FetusTissue::skin, head);
    add(1, FetusTissue::inside, shrunken(hand, skin));
    add(1, FetusTissue::skin, hand);
    add(2, FetusTissue::cord, cord());
    add(3, FetusTissue::wall, wall());
  }

  const std::vector<Layer>& layers() const { return m_layers; }
  Site site(const Vec3& point) const { return {point, -infinity}; }
  double signal(FetusTissue tissue, const Site& site) const { return echo(tissue, site.point); }

  /// Applies speckle of pulse size, attenuation with depth, and noise.
  std::int16_t acquired(double signal, const Vec3& point, std::uint64_t voxel) const {
    const double speckle =
        1.0 + 0.24 * valueNoise(point / 1.3, 21) + 0.14 * valueNoise(point / 0.7, 22);
    const double depth =
        1.0 - 0.0022 * (fetusFieldCenter.y() + 0.5 * fetusFieldOfView.y() - point.y());
    const double value = signal * speckle * depth + 3.0 * normalNoise(voxel);
    return static_cast<std::int16_t>(std::lround(std::clamp(value, 0.0, 255.0)));
  }

private:
  static Solid shrunken(const Solid& solid, double by) {
    return {[solid, by](const Vec3& p) { return solid.distance(p) + by; }, solid.box};
  }

  /// Two loops of the cord in front of the chin.
  static Solid cord() {
    const auto shape = std::make_shared<const Tube>(std::vector<TubeNode>{{{-52, 34, -34}, 4.5},
                                                                          {{-34, 46, -40}, 4.5},
                                                                          {{-16, 52, -34}, 4.5},
                                                                          {{2, 53, -42}, 4.5},
                                                                          {{18, 54, -52}, 4.5},
                                                                          {{30, 50, -62}, 4.5}});
    return {[shape](const Vec3& p) { return shape->distance(p); }, shape->box()};
  }

  /// Uterine wall with the placenta, around a cavity wider than the head.
  static Solid wall() {
    const auto distance = [](const Vec3& p) {
      const double wave = 2.0 * valueNoise(p / 17.0, 31) + 1.0 * valueNoise(p / 7.0, 32);
      return -ellipsoidDistance(p, {0, -4, -8}, {62, 58, 62}) + wave - 0.5;
    };
    const Vec3 half = 0.6 * fetusFieldOfView;
    return {distance, {fetusFieldCenter - half, fetusFieldCenter + half}};
  }

  void add(std::uint8_t label, FetusTissue tissue, const Solid& solid) {
    m_layers.push_back({label, tissue, solid.box, [distance = solid.distance](const Site& site) {
                          return distance(site.point);
                        }});
  }

  std::vector<Layer> m_layers;
};

} // namespace

Phantom makeFetusPhantom(const FetusOptions& options) {
  requirePhantomSize(options.size);
  constexpr Mat3 axes({-1, 0, 0}, {0, -1, 0}, {0, 0, 1}); // columns: left, posterior, superior
  const FetusSubject subject;
  Phantom phantom = paintPhantom(
      subject, phantomGrid(options.size, fetusFieldOfView, axes, fetusFieldCenter), "fetus");
  phantom.segments = {{"face", "Fetal face and hand", {0.93, 0.72, 0.58}, 1, 0},
                      {"cord", "Umbilical cord", {0.75, 0.55, 0.62}, 2, 0},
                      {"wall", "Uterine wall", {0.72, 0.36, 0.32}, 3, 0}};
  phantom.property = fetusProperty();
  phantom.towardViewer = {0.35, 1.0, 0.15};
  return phantom;
}

VolumeProperty fetusProperty() {
  VolumeProperty property;
  property.scalarOpacity = {{0, 0}, {35, 0}, {60, 0.4}, {90, 0.8}, {255, 0.9}};
  property.gradientOpacity = {{0, 1}, {255, 1}};
  property.color = {{0, {0.72, 0.42, 0.30}},
                    {70, {0.86, 0.58, 0.43}},
                    {140, {0.94, 0.72, 0.56}},
                    {255, {0.98, 0.84, 0.70}}};
  property.unitDistance = 1.0;
  property.shade = true;
  property.diffuse = 0.9;
  property.specular = 0.2;
  property.specularPower = 15.0;
  return property;
}

} // namespace fenestra
