#include "base/Error.h"
#include "phantoms/Phantoms.h"

namespace fenestra::core {

namespace {

constexpr std::int64_t publishedSize = 512;
const Size3 publishedFocus{255, 255, 391};
constexpr int maxScalar = 255;

std::int16_t sliceScalar(std::int64_t slice, std::int64_t count) {
  const auto last = static_cast<double>(count - 1);
  return static_cast<std::int16_t>(
      std::lround(maxScalar * (2.0 * static_cast<double>(slice) - last) / last));
}

/// Opaque within edge / 100, blue at -255 through purple to red at 255. No shading, since the only
/// gradients are between slices. A .vp file has no unit distance and cannot express this for an
/// edge far below 100 mm: Fenestra's opacity cap limits the extinction to 9.2 per mm there.
VolumeProperty cubeProperty(double edge) {
  VolumeProperty property;
  property.scalarOpacity = {{-maxScalar, 0.99}, {maxScalar, 0.99}};
  property.gradientOpacity = {{0, 1}, {255, 1}};
  // Not pure colors: a component of 0 would lose all light that scatters more than once.
  property.color = {
      {-maxScalar, {0.15, 0.25, 1.0}}, {0, {0.80, 0.50, 0.85}}, {maxScalar, {1.0, 0.20, 0.15}}};
  property.unitDistance = edge / 100.0;
  property.shade = false;
  return property;
}

} // namespace

Phantom makeCubePhantom(const CubeOptions& options) {
  const Size3 size = Size3::Constant(options.size);
  if (!(options.edge > 0.0) || !std::isfinite(options.edge))
    throw requestError(ErrorCode::invalidValue, "edge", "must be a positive number of mm");

  Phantom phantom;
  phantom.volume.grid =
      makePhantomGrid(size, Vec3::Constant(options.edge), Mat3::Identity(), Vec3::Zero());
  LargeArray<std::int16_t> voxels(static_cast<std::size_t>(size.prod()));
  const std::int64_t sliceVoxels = size.x() * size.y();
  for (std::int64_t k = 0; k < size.z(); ++k)
    std::fill_n(voxels.begin() + k * sliceVoxels, sliceVoxels, sliceScalar(k, size.z()));
  phantom.volume.voxels = std::move(voxels);
  phantom.volume.name = "cube";
  phantom.volume.minimum = -maxScalar;
  phantom.volume.maximum = maxScalar;

  PhantomLabels& labels = phantom.labels;
  labels.size = (publishedFocus * options.size).unaryExpr([](std::int64_t x) {
    return (x + publishedSize / 2) / publishedSize;
  });
  labels.offset = (size - labels.size) / 2;
  labels.layers.emplace_back(static_cast<std::size_t>(labels.size.prod()), std::uint8_t{1});
  phantom.segments = {{"focus", "Focus", {0.93, 0.78, 0.35}, 1, 0}};
  phantom.property = cubeProperty(options.edge);
  phantom.towardViewer = {-0.45, 1.0, 0.4};
  return phantom;
}

} // namespace fenestra::core
