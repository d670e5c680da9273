#pragma once
// The smooth part of the fill (SmoothFill.h), on a coarse grid.

#include <cstddef>
#include <vector>

namespace fenestra::core {

struct FillGrid;

/// Largest slope of the far surface across the boundary: depth per mm on the plane through the
/// target. At silhouettes, the context falls back from the focus by this slope; beside a level
/// surface, the focus would have a darker edge.
constexpr double maxFarSlope = 0.25;

/// A plate under tension, fitted along the boundary of the known samples: the u that minimizes
///     ∫ (Δu)² + |∇u|² / length²   outside, and
///     ∫ (u - depth)² / a³ + (∂u - slope)² / b   along the boundary,
/// where ∂u is its slope across the boundary, `slope` that of the known depths, limited to
/// maxFarSlope, a = length / 10 and b = 3 length / 100. A sum of quadratic B-splines. It depends on
/// integrals along the boundary: hardly on the pitch of the samples, and continuously on the
/// camera.
class FarSurface {
public:
  FarSurface(const FillGrid& grid, double length);

  /// Depths at positions of a row on the plane through the target, mm. Their slope is continuous.
  void findRow(const std::vector<double>& x, double y, std::vector<float>& depths) const;

private:
  struct Axis {
    double first = 0.0; ///< position of the first node, mm
    std::size_t count = 0;
  };
  /// The first of the three splines that are not 0 at a position, and the position in pitches after
  /// the node of the second one, from -1/2 to 1/2.
  struct Position {
    std::size_t first;
    double offset;
  };
  struct Equations;

  Axis makeAxis(double low, double high) const;
  Position locate(const Axis& axis, double at) const;
  /// Nodes are numbered along the shorter axis, so that unknowns depend on near ones.
  std::size_t index(std::size_t column, std::size_t row) const {
    return m_x.count < m_y.count ? row * m_x.count + column : column * m_y.count + row;
  }
  void placeNodes(const FillGrid& grid, double length);
  std::vector<double> findOpenness(const FillGrid& grid) const;
  void addEnergy(Equations& equations, const std::vector<double>& openness, double length) const;
  bool addBoundary(Equations& equations, const FillGrid& grid, double length) const;

  double m_pitch = 0.0; ///< of the nodes, mm
  Axis m_x, m_y;
  std::vector<double> m_weights; ///< of the splines, mm
};

} // namespace fenestra::core
