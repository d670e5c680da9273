#include "phantoms/Anatomy.h"
#include "phantoms/Noise.h"
#include "phantoms/Painter.h"
#include "phantoms/Phantoms.h"

namespace fenestra::core {

namespace {

const Vec3 fetusFieldOfView{112.0, 112.0, 112.0}; ///< mm along the voxel axes
const Vec3 fetusFieldCenter{0.0, 14.0, -8.0};     ///< world

// Echo strengths, 0 to 255; stronger in tissue that scatters more.
double insideEcho(const Vec3& p) {
  return 92.0 + 16.0 * valueNoise(p / 5.0, 11);
}
double wallEcho(const Vec3& p) {
  return 118.0 + 22.0 * valueNoise(p / 6.0, 12);
}

/// Uterine wall with the placenta, around a cavity wider than the head.
double uterineWall(const Vec3& p) {
  const double wave = 2.0 * valueNoise(p / 17.0, 31) + 1.0 * valueNoise(p / 7.0, 32);
  return -ellipsoidDistance(p, {0, -4, -8}, {62, 58, 62}) + wave - 0.5;
}

/// The fetus in amniotic fluid.
class FetusSubject : public LayeredSubject<PaintSite> {
public:
  static constexpr double background = 6.0; ///< fluid

  FetusSubject() : LayeredSubject(0.0) {
    const Anatomy anatomy = loadAnatomy("fetus");
    constexpr double skinThickness = 2.2, skinEcho = 165.0; // mm; as insideEcho
    const auto face = addSegment("face", "Fetal face and hand", {0.93, 0.72, 0.58});
    for (const Solid part : {anatomy.at("head"), anatomy.at("hand")}) {
      addLayer(face, insideEcho, part.box,
               [part](const Vec3& p) { return part.distance(p) + skinThickness; });
      addLayer(face, makeConstant(skinEcho), part.box, part.distance);
    }
    const Solid cord = anatomy.at("cord");
    addLayer(addSegment("cord", "Umbilical cord", {0.75, 0.55, 0.62}), makeConstant(130.0),
             cord.box, cord.distance);
    addLayer(addSegment("wall", "Uterine wall", {0.72, 0.36, 0.32}), wallEcho, everywhere,
             uterineWall);
  }

  PaintSite makeSite(const Vec3& point, double reach) const {
    return {point, reach, -infinity}; // skin is out of view
  }

  /// Applies speckle at pulse size, attenuation with depth, and noise.
  std::int16_t acquire(double signal, const Vec3& point, std::uint64_t voxel) const {
    const double speckle =
        1.0 + 0.24 * valueNoise(point / 1.3, 21) + 0.14 * valueNoise(point / 0.7, 22);
    const double depth =
        1.0 - 0.0022 * (fetusFieldCenter.y() + 0.5 * fetusFieldOfView.y() - point.y());
    const double value = signal * speckle * depth + 3.0 * normalNoise(voxel);
    return static_cast<std::int16_t>(std::lround(std::clamp(value, 0.0, 255.0)));
  }
};

/// Skin tones; fluid is transparent.
VolumeProperty fetusProperty() {
  VolumeProperty property;
  property.scalarOpacity = {{0, 0}, {35, 0}, {60, 0.4}, {90, 0.8}, {255, 0.9}};
  property.gradientOpacity = {{0, 1}, {255, 1}};
  property.color = {{0, {0.72, 0.42, 0.30}},
                    {70, {0.86, 0.58, 0.43}},
                    {140, {0.94, 0.72, 0.56}},
                    {255, {0.98, 0.84, 0.70}}};
  property.shade = true;
  property.specularPower = 15.0;
  return property;
}

} // namespace

Phantom makeFetusPhantom(const Size3& size, const PhantomProgress& progress) {
  constexpr Mat3 axes({-1, 0, 0}, {0, -1, 0}, {0, 0, 1}); // columns: left, posterior, superior
  Phantom phantom =
      paintPhantom(FetusSubject(), makePhantomGrid(size, fetusFieldOfView, axes, fetusFieldCenter),
                   "fetus", progress);
  phantom.property = fetusProperty();
  phantom.towardViewer = {0.35, 1.0, 0.15};
  return phantom;
}

} // namespace fenestra::core
