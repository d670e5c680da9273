#pragma once
// Rasterization of layered shapes into voxels.

#include "phantoms/Phantom.h"
#include "phantoms/Shapes.h"

#include <tbb/parallel_for.h>

#include <atomic>
#include <functional>

namespace fenestra::core {

struct PaintSite {
  Vec3 point;     ///< world
  double reach;   ///< mm; a distance beyond it only needs the right sign, and to be beyond it
  double surface; ///< mm to the subject's outer surface

  /// Lets functions of a point serve as functions of a site.
  operator const Vec3&() const { return point; }
};

inline const Box everywhere{Vec3::Constant(-infinity), Vec3::Constant(infinity)};

/// Base class of subjects: segments, and layers from front to back; each layer hides the later
/// ones. `S`: a PaintSite with the additional data that the layers need.
template <typename S>
class LayeredSubject {
public:
  using Site = S;
  using Field = std::function<double(const Site&)>;

  struct Layer {
    std::uint8_t label;
    Field signal;
    Box box;        ///< world; contains the shape
    Field distance; ///< to the shape, mm, negative inside
  };

  const std::vector<Layer>& layers() const { return m_layers; }
  const std::vector<PhantomSegment>& segments() const { return m_segments; }

protected:
  /// `margin`: mm by which a layer may exceed its given box.
  explicit LayeredSubject(double margin) : m_margin(margin) {}

  /// Adds a segment; returns its label.
  std::uint8_t addSegment(const std::string& id, const std::string& name, const Rgb& color) {
    const auto label = static_cast<std::uint8_t>(m_segments.size() + 1);
    m_segments.push_back({id, name, color, label, 0});
    return label;
  }

  /// Adds a layer behind the existing ones.
  void addLayer(std::uint8_t label, Field signal, const Box& box, Field distance) {
    m_layers.push_back({label, std::move(signal), expandBox(box, m_margin), std::move(distance)});
  }

  static Field makeConstant(double signal) {
    return [signal](const Site&) { return signal; };
  }
  /// Distance to the surface that lies `depth` mm below the subject's outer surface.
  static Field makeInset(double depth) {
    return [depth](const Site& site) { return site.surface + depth; };
  }
  /// `bound`: the shape that takes less time, and often suffices.
  static Field makeIntersection(Field shape, Field bound) {
    return [shape = std::move(shape), bound = std::move(bound)](const Site& site) {
      const double outside = bound(site);
      return outside > site.reach ? outside : std::max(shape(site), outside);
    };
  }

private:
  double m_margin;
  std::vector<Layer> m_layers;
  std::vector<PhantomSegment> m_segments;
};

inline const Rgb boneColor{0.945, 0.839, 0.569};
inline const Rgb cartilageColor{0.435, 0.722, 0.824};
inline const Rgb tendonColor{0.718, 0.839, 0.827};
inline const Rgb muscleColor{0.753, 0.408, 0.345};
inline const Rgb vesselColor{0.847, 0.396, 0.310};
inline const Rgb fatColor{0.902, 0.863, 0.275};
inline const Rgb skinColor{0.694, 0.478, 0.396};

/// Paints each voxel of a grid from the front layer to the back, until it is completely covered.
///
/// A Subject is a LayeredSubject with `background`, the signal around the subject;
/// `makeSite(point, reach)`, which may leave the site incomplete where its surface is farther away
/// than `reach`; and `acquire(signal, point, voxel)`, the scanner's output, int16.
template <typename Subject>
class Painter {
public:
  using Layer = typename Subject::Layer;

  /// Signal and label at a point.
  struct Sample {
    double signal = 0.0;
    std::uint8_t label = 0;
    double boundaryDistance = infinity; ///< mm to the nearest boundary of a visible layer
  };

  Painter(const Subject& subject, const Grid& grid)
      : m_subject(subject),
        m_rowStep(grid.indexToWorld.linear().col(0)),
        m_sliceStep(grid.indexToWorld.linear().col(2)),
        m_softness(0.6 * std::cbrt(grid.spacing().prod())),
        m_boundaryRange(m_softness + m_sliceStep.norm() / 3.0) {}

  /// A layer that a row of voxels can intersect.
  struct RowLayer {
    const Layer* layer;
    Box box; ///< outside, the layer covers nothing
  };
  using Row = std::vector<RowLayer>;

  /// Layers that a row of voxels along the first axis can intersect.
  Row findRowLayers(const Vec3& start, std::int64_t count) const {
    const double length = m_rowStep.norm();
    const Ray row{start, m_rowStep / length};
    const Interval range{-length, length * static_cast<double>(count)};
    Row layers;
    for (const Layer& layer : m_subject.layers())
      if (!expandBox(layer.box, m_boundaryRange).clip(row, range).isEmpty())
        layers.push_back({&layer, expandBox(layer.box, m_softness)});
    return layers;
  }

  /// Mean over the slice's thickness, which equals the slice distance: from three points near a
  /// boundary, elsewhere from the center alone.
  Sample paintVoxel(const Row& row, const Vec3& center) const {
    Sample middle = paint(row, center);
    if (middle.boundaryDistance > m_boundaryRange)
      return middle;
    for (const double offset : {-1.0 / 3.0, 1.0 / 3.0})
      middle.signal += paint(row, center + offset * m_sliceStep).signal;
    middle.signal /= 3.0;
    return middle;
  }

private:
  Sample paint(const Row& row, const Vec3& point) const {
    const auto site = m_subject.makeSite(point, m_boundaryRange);
    Sample sample;
    sample.signal = m_subject.background;
    sample.boundaryDistance = std::abs(site.surface);
    if (site.surface > m_softness)
      return sample;
    sample.signal = 0.0;
    double visible = 1.0; // fraction of the voxel not yet covered
    for (const auto& [layer, box] : row) {
      if (!contains(box, point))
        continue;
      const double distance = layer->distance(site);
      sample.boundaryDistance = std::min(sample.boundaryDistance, std::abs(distance));
      // A voxel at a boundary contains a fraction of either side: the partial volume effect.
      const double coverage = smoothStep(m_softness, -m_softness, distance);
      if (coverage == 0.0)
        continue;
      if (sample.label == 0 && distance <= 0.0)
        sample.label = layer->label;
      sample.signal += visible * coverage * layer->signal(site);
      visible *= 1.0 - coverage;
      if (visible < 1e-3)
        break;
    }
    sample.signal += visible * m_subject.background;
    return sample;
  }

  const Subject& m_subject;
  Vec3 m_rowStep, m_sliceStep; ///< vectors to the next voxel in a row, and to the next slice
  double m_softness;           ///< mm; half the width of a boundary
  /// Largest distance from a voxel's center, mm, at which a boundary affects the voxel.
  double m_boundaryRange;
};

/// Paints the subject's volume, called `name`, and one layer of labels on the complete grid. The
/// result does not depend on run or number of threads.
template <typename Subject>
Phantom paintPhantom(const Subject& subject, const Grid& grid, const std::string& name,
                     const PhantomProgress& progress) {
  const Painter painter(subject, grid);
  const auto count = static_cast<std::size_t>(grid.voxelCount());
  LargeArray<std::int16_t> voxels(count);
  std::vector<std::uint8_t> labels(count);
  const Size3& size = grid.size;
  std::atomic<std::int64_t> finishedSlices = 0;
  tbb::parallel_for(std::int64_t{0}, size.z(), [&](std::int64_t k) {
    for (std::int64_t j = 0; j < size.y(); ++j) {
      const Vec3 start = grid.indexToWorld * Size3{0, j, k}.cast<double>();
      const auto row = painter.findRowLayers(start, size.x());
      for (std::int64_t i = 0; i < size.x(); ++i) {
        const Vec3 point = grid.indexToWorld * Size3{i, j, k}.cast<double>();
        const auto sample = painter.paintVoxel(row, point);
        const auto at = static_cast<std::size_t>(i + size.x() * (j + size.y() * k));
        voxels[at] = subject.acquire(sample.signal, point, at);
        labels[at] = sample.label;
      }
    }
    const std::int64_t finished = ++finishedSlices;
    if (progress)
      progress(static_cast<double>(finished) / static_cast<double>(size.z()));
  });
  Phantom phantom;
  phantom.volume.grid = grid;
  phantom.volume.voxels = std::move(voxels);
  phantom.volume.name = name;
  computeRange(phantom.volume);
  phantom.labels.size = size;
  phantom.labels.layers.push_back(std::move(labels));
  phantom.segments = subject.segments();
  return phantom;
}

} // namespace fenestra::core
