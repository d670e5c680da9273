#include "phantoms/Foot.h"

#include "phantoms/FootLayers.h"
#include "phantoms/Noise.h"

namespace fenestra {

namespace {

const Vec3 footFieldOfView{280.0, 112.0, 140.0}; ///< mm along the voxel axes
const Vec3 footFieldCenter{-2.0, 131.0, 64.0};   ///< world

/// The foot, a Subject of Painter.
struct FootSubject {
  using Site = FootSite;
  using Layer = FootLayer;
  static constexpr double background = -1000.0; ///< air

  FootLayers foot;

  const std::vector<Layer>& layers() const { return foot.layers(); }
  Site site(const Vec3& point) const { return foot.site(point); }
  double signal(FootTissue tissue, const Site& site) const { return foot.signal(tissue, site); }
  /// Adds noise, and clips to 12 bits like a scanner.
  std::int16_t acquired(double signal, const Vec3&, std::uint64_t voxel) const {
    const double noisy = std::clamp(signal + footNoise * normalNoise(voxel), -1024.0, 3071.0);
    return static_cast<std::int16_t>(std::lround(noisy));
  }
};

/// Adds layer 1: all voxels of at least footBoneThreshold.
void addThresholdedBones(Phantom& phantom) {
  const auto& voxels = std::get<std::vector<std::int16_t>>(phantom.volume.voxels);
  std::vector<std::uint8_t> bones(voxels.size());
  for (std::size_t i = 0; i < voxels.size(); ++i)
    bones[i] = voxels[i] >= footBoneThreshold;
  phantom.labels.layers.push_back(std::move(bones));
  phantom.segments.push_back({"bones", "Bones", {0.945, 0.902, 0.784}, 1, 1});
}

} // namespace

Phantom makeFootPhantom(const FootOptions& options) {
  requirePhantomSize(options.size);
  constexpr Mat3 axes({0, 1, 0}, {-1, 0, 0}, {0, 0, 1}); // columns: anterior, left, superior
  const FootSubject subject;
  Phantom phantom = paintPhantom(
      subject, phantomGrid(options.size, footFieldOfView, axes, footFieldCenter), "foot");
  phantom.segments = subject.foot.segments();
  addThresholdedBones(phantom);
  phantom.property = footProperty();
  phantom.towardViewer = {-0.9, 0.75, 0.75};
  return phantom;
}

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
  property.unitDistance = 1.0;
  property.shade = true;
  property.diffuse = 0.9;
  property.specular = 0.2;
  property.specularPower = 15.0;
  return property;
}

} // namespace fenestra
