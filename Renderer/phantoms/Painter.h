#pragma once
// Conversion of layers of shapes to voxels.

#include "phantoms/Phantom.h"
#include "phantoms/Shapes.h"

#include <tbb/parallel_for.h>

#include <functional>

namespace fenestra {

/// Shape that hides later ones.
template <typename Site, typename Tissue>
struct PaintLayer {
  std::uint8_t label;
  Tissue tissue;
  Box box;                                     ///< world; the shape lies inside it
  std::function<double(const Site&)> distance; ///< mm, negative inside
};

/// mm; reach of soft borders beyond a shape.
inline constexpr double boxMargin = 1.5;
inline const Box everywhere{Vec3::Constant(-infinity), Vec3::Constant(infinity)};
inline const Rgb boneColor{0.945, 0.839, 0.569};

/// Paints places of a grid, from the front layer back until the voxel is full.
///
/// A Subject has: `Site`, a place with the data that its layers need, such as `surface`, mm to the
/// subject's outside; `Layer`, a PaintLayer; `background`, the signal around the subject;
/// `layers()`, front to back; `site(point)`, world; `signal(tissue, site)`; and `acquired(signal,
/// point, voxel)`, the scanner's value, int16.
template <typename Subject>
class Painter {
public:
  using Layer = typename Subject::Layer;

  /// Signal and label at a place.
  struct Sample {
    double signal = 0.0;
    std::uint8_t label = 0;
    double border = infinity; ///< mm to the nearest border in a visible layer
  };

  Painter(const Subject& subject, const Grid& grid)
      : m_subject(subject),
        m_rowStep(grid.indexToWorld.linear().col(0)),
        m_sliceStep(grid.indexToWorld.linear().col(2)),
        m_softness(0.6 * std::cbrt(grid.spacing().prod())) {}

  /// Layers that a row of voxels along the first axis can meet.
  std::vector<const Layer*> layersOfRow(const Vec3& start, std::int64_t count) const {
    const double length = m_rowStep.norm();
    const Ray row{start, m_rowStep / length};
    const Interval range{-length, length * static_cast<double>(count)};
    std::vector<const Layer*> layers;
    for (const Layer& layer : m_subject.layers())
      if (!expanded(layer.box, reach()).clip(row, range).empty())
        layers.push_back(&layer);
    return layers;
  }

  /// Mean over the slice's thickness, which equals the slice distance; near a border from three
  /// places, elsewhere from the middle alone.
  Sample voxel(const std::vector<const Layer*>& row, const Vec3& center) const {
    Sample middle = paint(row, center);
    if (middle.border > reach())
      return middle;
    for (const double offset : {-1.0 / 3.0, 1.0 / 3.0})
      middle.signal += paint(row, center + offset * m_sliceStep).signal;
    middle.signal /= 3.0;
    return middle;
  }

private:
  /// Largest distance from a voxel's middle, mm, at which a border shows in the voxel.
  double reach() const { return m_softness + m_sliceStep.norm() / 3.0; }

  bool mayHold(const Layer& layer, const Vec3& point) const {
    return (point.array() >= layer.box.lower.array() - m_softness).all() &&
           (point.array() <= layer.box.upper.array() + m_softness).all();
  }

  Sample paint(const std::vector<const Layer*>& row, const Vec3& point) const {
    const auto site = m_subject.site(point);
    Sample sample;
    sample.signal = m_subject.background;
    sample.border = std::abs(site.surface);
    if (site.surface > m_softness)
      return sample;
    sample.signal = 0.0;
    double visible = 1.0; // share of the voxel not yet covered
    for (const Layer* layer : row) {
      if (!mayHold(*layer, point))
        continue;
      const double distance = layer->distance(site);
      sample.border = std::min(sample.border, std::abs(distance));
      // A voxel on a border holds a share of either side: the partial volume effect.
      const double share = smoothStep(m_softness, -m_softness, distance);
      if (share == 0.0)
        continue;
      if (sample.label == 0 && distance <= 0.0)
        sample.label = layer->label;
      sample.signal += visible * share * m_subject.signal(layer->tissue, site);
      visible *= 1.0 - share;
      if (visible < 1e-3)
        break;
    }
    sample.signal += visible * m_subject.background;
    return sample;
  }

  const Subject& m_subject;
  Vec3 m_rowStep, m_sliceStep; ///< vectors between neighbours in a row, and between slices
  double m_softness;           ///< mm; half the width of a border
};

/// The subject's volume, named `name`, and one layer of labels on the whole grid. Independent of
/// run and number of threads.
template <typename Subject>
Phantom paintPhantom(const Subject& subject, const Grid& grid, const std::string& name) {
  const Painter painter(subject, grid);
  const auto count = static_cast<std::size_t>(grid.voxelCount());
  std::vector<std::int16_t> voxels(count);
  std::vector<std::uint8_t> labels(count);
  const Size3& size = grid.size;
  tbb::parallel_for(std::int64_t{0}, size.z(), [&](std::int64_t k) {
    for (std::int64_t j = 0; j < size.y(); ++j) {
      const Vec3 start = grid.indexToWorld * Size3{0, j, k}.cast<double>();
      const auto row = painter.layersOfRow(start, size.x());
      for (std::int64_t i = 0; i < size.x(); ++i) {
        const Vec3 point = grid.indexToWorld * Size3{i, j, k}.cast<double>();
        const auto sample = painter.voxel(row, point);
        const auto at = static_cast<std::size_t>(i + size.x() * (j + size.y() * k));
        voxels[at] = subject.acquired(sample.signal, point, at);
        labels[at] = sample.label;
      }
    }
  });
  Phantom phantom;
  phantom.volume.grid = grid;
  phantom.volume.voxels = std::move(voxels);
  phantom.volume.name = name;
  computeRange(phantom.volume);
  phantom.labels.size = size;
  phantom.labels.layers.push_back(std::move(labels));
  return phantom;
}

} // namespace fenestra
