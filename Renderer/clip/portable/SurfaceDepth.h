#pragma once
// Depth of a closed surface of triangles along camera rays: a z-buffer.

#include <array>
#include <cstdint>
#include <vector>

namespace fenestra::core {

/// Triangles, counterclockwise as seen from outside.
struct SurfaceTriangles {
  std::vector<float> points;          ///< x, y and z of each point, mm
  std::vector<std::uint32_t> corners; ///< three points per triangle
};

/// A closed surface, in which each edge belongs to two triangles.
class ClosedSurface {
public:
  struct Edge {
    std::array<std::uint32_t, 2> points, triangles;
  };

  explicit ClosedSurface(SurfaceTriangles triangles);

  const std::vector<float>& points() const { return m_triangles.points; }
  const std::vector<std::uint32_t>& corners() const { return m_triangles.corners; }
  /// Edges between two triangles. Edges of one triangle, or of more than two, are left out.
  const std::vector<Edge>& edges() const { return m_edges; }

private:
  SurfaceTriangles m_triangles;
  std::vector<Edge> m_edges;
};

/// How a camera sees the world.
struct ViewFrame {
  /// Rows of the affine map from world to view space, mm: right, up, and the depth.
  std::array<std::array<double, 4>, 3> toView;
  double targetDepth; ///< mm, above 0
  bool isPerspective;
};

/// Samples on the plane through the target, where camera rays meet it; all rays of a row or column
/// of pixels meet the same row or column of samples.
struct SampleGrid {
  double x, y;  ///< of the first sample, the upper left one, mm
  double pitch; ///< mm; y decreases from row to row
  int columns, rows;
};

/// A surface as a camera sees it.
class ProjectedSurface {
public:
  /// Non-owning: the surface must outlive the object.
  ProjectedSurface(const ClosedSurface& surface, const ViewFrame& view);

  /// Bounds of the points in front of the camera, on the plane through the target, mm; lower >
  /// upper if there are none.
  struct Bounds {
    double lowerX, upperX, lowerY, upperY;
  };
  const Bounds& bounds() const { return m_bounds; }

  /// Depth of the triangle nearest to the camera on the ray through each sample, mm, row by row;
  /// infinity where there is none. Triangles that reach behind the camera are ignored.
  std::vector<float> findDepths(const SampleGrid& grid) const;

  /// Point where the surface turns away from the camera: on the plane through the target, and
  /// depth, mm.
  struct ContourPoint {
    double x, y, depth;
  };
  struct ContourEdge {
    std::array<ContourPoint, 2> ends;
  };
  /// Edges between triangles that face the camera and others, hidden ones included.
  std::vector<ContourEdge> findContour() const;

private:
  struct Corner {
    double x, y; ///< on the plane through the target, mm
    /// -depth, or 1 / depth in perspective: linear on a triangle's image, and greater if nearer.
    double nearness;
  };

  template <typename Number>
  Number toDepth(Number nearness) const {
    return m_isPerspective ? 1 / nearness : -nearness;
  }
  bool isInFront(const Corner& corner) const { return !m_isPerspective || corner.nearness > 0.0; }
  void addPoint(double right, double up, double depth, double targetDepth);
  bool isFacing(std::size_t triangle) const;

  const ClosedSurface& m_surface;
  bool m_isPerspective;
  std::vector<Corner> m_corners;
  Bounds m_bounds;
  bool m_isCameraOutside = true;        ///< certainly
  std::vector<std::uint8_t> m_isFacing; ///< per triangle: 1 if its outside faces the camera
};

} // namespace fenestra::core
