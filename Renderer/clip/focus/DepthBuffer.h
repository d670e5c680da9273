#pragma once
// Depth map of the clipping surface, on the plane through the target, parallel to the image plane.

#include "model/camera/Camera.h"
#include "model/volume/Grid.h"

#include <cstdint>
#include <vector>

namespace fenestra::core {

/// Converts a world point to buffer coordinates: (x, y), mm, where its camera ray meets the plane
/// through the target, and its depth. In perspective, defined for positive depths only.
inline Vec3 toBuffer(const Camera& camera, const Vec3& world) {
  const Vec3 view = camera.toView(world);
  if (camera.pose().projection == Projection::orthographic)
    return view;
  const double scale = camera.targetDepth() / view.z();
  return {view.x() * scale, view.y() * scale, view.z()};
}

/// Inverse of toBuffer: the world point at depth at.z(), mm, on the camera ray through (x, y).
inline Vec3 fromBuffer(const Camera& camera, const Vec3& at) {
  const Ray ray = camera.makePlaneRay(at.head<2>());
  return ray.at(at.z() / camera.depthPerLength(ray));
}

/// True for depth <= 0 in perspective.
inline bool isBehindCamera(const Camera& camera, double depth) {
  return camera.pose().projection == Projection::perspective && !(depth > 0.0);
}

/// Sample positions along one axis of a depth buffer: the pixel centers inside the viewport, and
/// every `factor` pixels beyond it.
struct DepthAxis {
  double pitch = 1.0;      ///< mm per pixel; negative for rows, which run downward
  double start = 0.0;      ///< coordinate of the first viewport pixel, in units of pitch
  double factor = 1.0;     ///< pixels per sample beyond the viewport, an integer
  std::int64_t before = 0; ///< samples before the viewport
  std::int64_t inside = 1; ///< pixels of the viewport
  std::int64_t after = 0;  ///< samples after the viewport

  std::int64_t size() const { return before + inside + after; }

  /// Coordinate of a sample, mm; extrapolated for indices that are out of range.
  double coordinate(std::int64_t sample) const {
    const auto pixel = static_cast<double>(sample - before);
    const double fine = clampToViewport(pixel);
    return pitch * (start + fine + factor * (pixel - fine));
  }

  std::vector<double> coordinates() const {
    std::vector<double> all;
    for (std::int64_t sample = 0; sample < size(); ++sample)
      all.push_back(coordinate(sample));
    return all;
  }

  /// Continuous index of a coordinate (mm), clamped to [0, size - 1].
  double index(double coordinate) const {
    const double pixel = coordinate / pitch - start;
    const double fine = clampToViewport(pixel);
    const double index = static_cast<double>(before) + fine + (pixel - fine) / factor;
    return std::max(0.0, std::min(static_cast<double>(size() - 1), index)); // NaN: size - 1
  }

  /// Samples that interpolation over [a, b] (mm) reads, extended by `slack` samples on both sides.
  struct SampleRange {
    std::int64_t first, last;
  };
  SampleRange sampleRange(double a, double b, double slack) const {
    const auto [low, high] = std::minmax({index(a), index(b)});
    return {static_cast<std::int64_t>(std::max(0.0, low - slack)),
            std::min(size() - 1, static_cast<std::int64_t>(std::ceil(high + slack)))};
  }

private:
  double clampToViewport(double pixel) const {
    return std::clamp(pixel, 0.0, static_cast<double>(inside - 1));
  }
};

/// Depths, mm, over (x, y), mm, where camera rays meet the plane through the target. Covers the
/// viewport and the volume's projection (in perspective, up to 75 degrees from the axis). Beyond
/// the samples, the depth of the nearest edge sample applies. Row 0 is the top row.
class DepthBuffer {
public:
  /// Initializes all depths to infinity. Beyond the viewport, samples have its pixel spacing, or
  /// the finest spacing for which the buffer fits in max(4 Mpixel, 5/4 of the viewport). Throws
  /// Error (request) if the viewport is empty.
  DepthBuffer(const Camera& camera, const Grid& volume);

  const DepthAxis& xAxis() const { return m_x; }
  const DepthAxis& yAxis() const { return m_y; }
  std::int64_t columns() const { return m_x.size(); }
  std::int64_t rows() const { return m_y.size(); }
  std::int64_t size() const { return columns() * rows(); }
  std::int64_t sample(std::int64_t column, std::int64_t row) const {
    return row * columns() + column;
  }
  /// Sample at the center of a viewport pixel.
  std::int64_t viewportSample(std::int64_t column, std::int64_t row) const {
    return sample(m_x.before + column, m_y.before + row);
  }
  Vec2 position(std::int64_t column, std::int64_t row) const {
    return {m_x.coordinate(column), m_y.coordinate(row)};
  }

  /// Depths minus reference(), mm, in row-major order.
  const std::vector<float>& depthsFromReference() const { return m_depths; }
  /// Depth of the camera's target, mm.
  double reference() const { return m_reference; }
  double at(std::int64_t sample) const { return m_reference + m_depths[index(sample)]; }
  void set(std::int64_t sample, double depth) {
    m_depths[index(sample)] = static_cast<float>(depth - m_reference);
  }

  /// Moves all depths `offset` mm away from the camera.
  void move(double offset);

  /// Cell between four samples, and a position in it.
  struct Cell {
    std::int64_t column, row;         ///< of the cell's first sample
    std::int64_t nextColumn, nextRow; ///< of the cell's last sample
    Vec2 fraction;                    ///< position between first and last sample, 0 to 1
  };
  Cell cell(const Vec2& position) const {
    const Neighbors x = neighbors(m_x, position.x());
    const Neighbors y = neighbors(m_y, position.y());
    return {x.low, y.low, x.high, y.high, Vec2(x.fraction, y.fraction)};
  }

  /// Bilinear interpolation of the four samples, which must be finite.
  double interpolate(const Cell& cell) const {
    const auto lerp = [](double a, double b, double f) { return a + (b - a) * f; };
    const auto row = [&](std::int64_t r) {
      return lerp(m_depths[index(sample(cell.column, r))],
                  m_depths[index(sample(cell.nextColumn, r))], cell.fraction.x());
    };
    return m_reference + lerp(row(cell.row), row(cell.nextRow), cell.fraction.y());
  }
  double depth(const Vec2& position) const { return interpolate(cell(position)); }

  /// Gradient of interpolate(), mm per mm. Zero along an axis at whose end the position lies, since
  /// the depth is constant beyond the samples.
  Vec2 gradient(const Cell& cell) const {
    const auto depth = [&](std::int64_t column, std::int64_t row) {
      return static_cast<double>(m_depths[index(sample(column, row))]);
    };
    const double first = depth(cell.column, cell.row), right = depth(cell.nextColumn, cell.row);
    const double below = depth(cell.column, cell.nextRow);
    const double last = depth(cell.nextColumn, cell.nextRow);
    const Vec2& f = cell.fraction;
    const double alongX = (1.0 - f.y()) * (right - first) + f.y() * (last - below);
    const double alongY = (1.0 - f.x()) * (below - first) + f.x() * (last - right);
    return {alongX * samplesPerMm(m_x, cell.column, f.x()),
            alongY * samplesPerMm(m_y, cell.row, f.y())};
  }

  /// Depth of the nearest sample.
  double nearestDepth(const Vec2& position) const {
    const auto column = static_cast<std::int64_t>(m_x.index(position.x()) + 0.5);
    const auto row = static_cast<std::int64_t>(m_y.index(position.y()) + 0.5);
    return at(sample(column, row));
  }

private:
  struct Neighbors {
    std::int64_t low, high;
    double fraction;
  };

  static Neighbors neighbors(const DepthAxis& axis, double coordinate) {
    const double x = axis.index(coordinate);
    const auto low = static_cast<std::int64_t>(x);
    return {low, std::min(low + 1, axis.size() - 1), x - static_cast<double>(low)};
  }
  /// Samples per mm in the cell that begins with sample `low`; 0 at the ends of the axis.
  static double samplesPerMm(const DepthAxis& axis, std::int64_t low, double fraction) {
    const bool isEnd = low + 1 >= axis.size() || (low == 0 && fraction == 0.0);
    return isEnd ? 0.0 : 1.0 / (axis.coordinate(low + 1) - axis.coordinate(low));
  }
  static std::size_t index(std::int64_t sample) { return static_cast<std::size_t>(sample); }

  DepthAxis m_x, m_y;
  double m_reference;          ///< mm, depth of the camera's target
  std::vector<float> m_depths; ///< mm, minus m_reference: float suffices for distant cameras, too
};

} // namespace fenestra::core
