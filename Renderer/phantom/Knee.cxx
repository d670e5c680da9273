#include "phantom/Knee.h"

#include "core/Error.h"
#include "phantom/KneeLayers.h"
#include "phantom/Noise.h"

#include <tbb/parallel_for.h>

namespace fenestra {

namespace {

const Vec3 fieldOfView{120.0, 137.6, 120.0}; ///< mm along the voxel axes
const Vec3 fieldCenter{0.0, -2.0, 6.8};      ///< world

Grid kneeGrid(const Size3& size) {
  const Vec3 spacing = fieldOfView.cwiseQuotient(size.cast<double>());
  Mat3 axes; // columns: posterior, inferior, right
  axes << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  Affine indexToWorld = Affine::Identity();
  indexToWorld.linear() = axes * spacing.asDiagonal();
  const Vec3 middle = 0.5 * (size.cast<double>() - Vec3::Ones());
  indexToWorld.translation() = fieldCenter - indexToWorld.linear() * middle;
  return {size, indexToWorld};
}

/// What is at a place.
struct Sample {
  double signal = 0.0;
  std::uint8_t label = 0;
  double border = infinity; ///< mm to the next border that could show
};

/// Paints places of a grid, from the front layer back until nothing more shows.
class Painter {
public:
  Painter(const KneeLayers& knee, const Grid& grid)
      : m_knee(knee),
        m_sliceStep(grid.indexToWorld.linear().col(2)),
        m_softness(0.6 * std::cbrt(grid.spacing().prod())) {}

  /// The layers that a row of voxels along y can meet.
  std::vector<const Layer*> layersOfRow(double x, double z) const {
    const double margin = 0.5 * m_sliceStep.norm();
    std::vector<const Layer*> row;
    for (const Layer& layer : m_knee.layers()) {
      const Box box = expanded(layer.box, margin);
      if (x >= box.lower.x() && x <= box.upper.x() && z >= box.lower.z() && z <= box.upper.z())
        row.push_back(&layer);
    }
    return row;
  }

  /// A slice is as thick as it is far from the next: a voxel shows the mean across it, which takes
  /// more than its middle only where a border is near.
  Sample voxel(const std::vector<const Layer*>& row, const Vec3& center) const {
    Sample middle = paint(row, center);
    if (middle.border > m_softness + m_sliceStep.norm() / 3.0)
      return middle;
    for (const double offset : {-1.0 / 3.0, 1.0 / 3.0})
      middle.signal += paint(row, center + offset * m_sliceStep).signal;
    middle.signal /= 3.0;
    return middle;
  }

private:
  Sample paint(const std::vector<const Layer*>& row, const Vec3& point) const {
    const Site site = m_knee.site(point);
    Sample sample;
    sample.border = std::abs(site.leg);
    if (site.leg > m_softness)
      return sample;
    double visible = 1.0; // what the layers so far leave of the voxel
    for (const Layer* layer : row) {
      if (point.y() < layer->box.lower.y() || point.y() > layer->box.upper.y())
        continue;
      const double distance = layer->distance(site);
      sample.border = std::min(sample.border, std::abs(distance));
      // A voxel on a border holds some of either side: the partial volume effect.
      const double share = smoothStep(m_softness, -m_softness, distance);
      if (share == 0.0)
        continue;
      if (sample.label == 0 && distance <= 0.0)
        sample.label = layer->label;
      sample.signal += visible * share * tissueSignal(layer->tissue, point);
      visible *= 1.0 - share;
      if (visible < 1e-3)
        break;
    }
    return sample;
  }

  const KneeLayers& m_knee;
  Vec3 m_sliceStep;  ///< from a slice to the next, mm
  double m_softness; ///< mm: half the width of a border
};

void paintSlice(const Painter& painter, const Grid& grid, std::int64_t slice,
                std::vector<std::int16_t>& voxels, std::vector<std::uint8_t>& labels) {
  for (std::int64_t j = 0; j < grid.size.y(); ++j) {
    const Vec3 start = grid.indexToWorld * Size3{0, j, slice}.cast<double>();
    const std::vector<const Layer*> row = painter.layersOfRow(start.x(), start.z());
    for (std::int64_t i = 0; i < grid.size.x(); ++i) {
      const Vec3 point = grid.indexToWorld * Size3{i, j, slice}.cast<double>();
      const Sample voxel = painter.voxel(row, point);
      const std::int64_t index = i + grid.size.x() * (j + grid.size.y() * slice);
      const auto at = static_cast<std::size_t>(index);
      const double signal = ricianNoise(voxel.signal * biasField(point), noiseSigma, at);
      voxels[at] = static_cast<std::int16_t>(std::lround(signal));
      labels[at] = voxel.label;
    }
  }
}

} // namespace

Phantom makeKneePhantom(const KneeOptions& options) {
  if ((options.size.array() < 16).any() || (options.size.array() > 1024).any())
    throw usageError("--size: each of the three numbers of voxels is to lie between 16 and 1024");
  const KneeLayers knee;
  Phantom phantom;
  Grid& grid = phantom.volume.grid = kneeGrid(options.size);
  const auto count = static_cast<std::size_t>(grid.voxelCount());
  std::vector<std::int16_t> voxels(count);
  phantom.labels.resize(count);
  const Painter painter(knee, grid);
  tbb::parallel_for(std::int64_t{0}, grid.size.z(), [&](std::int64_t slice) {
    paintSlice(painter, grid, slice, voxels, phantom.labels);
  });
  phantom.volume.voxels = std::move(voxels);
  phantom.volume.name = "knee phantom";
  computeRange(phantom.volume);
  phantom.segments = knee.segments();
  phantom.property = kneeProperty();
  return phantom;
}

} // namespace fenestra
