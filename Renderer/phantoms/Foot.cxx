#include "phantoms/Foot.h"

#include "phantoms/FootLayers.h"

namespace fenestra {

namespace {

const Vec3 footFieldOfView{280.0, 112.0, 140.0}; ///< mm along the voxel axes
const Vec3 footFieldCenter{-2.0, 131.0, 64.0};   ///< world
constexpr int footBoneThreshold = 200;           ///< HU

/// Adds layer 1: all voxels of at least footBoneThreshold.
void addThresholdedBones(Phantom& phantom) {
  const auto& voxels = std::get<std::vector<std::int16_t>>(phantom.volume.voxels);
  std::vector<std::uint8_t> bones(voxels.size());
  for (std::size_t i = 0; i < voxels.size(); ++i)
    bones[i] = voxels[i] >= footBoneThreshold;
  phantom.labels.layers.push_back(std::move(bones));
  phantom.segments.push_back({"bones", "Bones", {0.945, 0.902, 0.784}, 1, 1});
}

/// Ivory bones in translucent skin, fat, muscle and tendon.
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
  property.shade = true;
  property.specularPower = 15.0;
  return property;
}

} // namespace

Phantom makeFootPhantom(const FootOptions& options) {
  requirePhantomSize(options.size);
  constexpr Mat3 axes({0, 1, 0}, {-1, 0, 0}, {0, 0, 1}); // columns: anterior, left, superior
  Phantom phantom = paintPhantom(
      FootLayers(), phantomGrid(options.size, footFieldOfView, axes, footFieldCenter), "foot");
  addThresholdedBones(phantom);
  phantom.property = footProperty();
  phantom.towardViewer = {-0.9, 0.75, 0.75};
  return phantom;
}

} // namespace fenestra
