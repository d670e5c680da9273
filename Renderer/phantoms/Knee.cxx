#include "phantoms/Knee.h"

#include "phantoms/KneeLayers.h"
#include "phantoms/Noise.h"

namespace fenestra {

namespace {

const Vec3 kneeFieldOfView{120.0, 137.6, 120.0}; ///< mm along the voxel axes
const Vec3 kneeFieldCenter{0.0, -2.0, 6.8};      ///< world

/// The knee, a Subject of Painter.
struct KneeSubject {
  using Site = KneeSite;
  using Layer = KneeLayer;
  static constexpr double background = 0.0;

  KneeLayers knee;

  const std::vector<Layer>& layers() const { return knee.layers(); }
  Site site(const Vec3& point) const { return knee.site(point); }
  double signal(KneeTissue tissue, const Site& site) const {
    return tissueSignal(tissue, site.point);
  }
  std::int16_t acquired(double signal, const Vec3& point, std::uint64_t voxel) const {
    const double noisy = ricianNoise(signal * biasField(point), noiseSigma, voxel);
    return static_cast<std::int16_t>(std::lround(noisy));
  }
};

} // namespace

Phantom makeKneePhantom(const KneeOptions& options) {
  requirePhantomSize(options.size);
  constexpr Mat3 axes({0, -1, 0}, {0, 0, -1}, {1, 0, 0}); // columns: posterior, inferior, right
  const KneeSubject subject;
  Phantom phantom = paintPhantom(
      subject, phantomGrid(options.size, kneeFieldOfView, axes, kneeFieldCenter), "knee");
  phantom.segments = subject.knee.segments();
  phantom.property = kneeProperty();
  return phantom;
}

} // namespace fenestra
