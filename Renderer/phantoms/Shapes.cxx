#include "phantoms/Shapes.h"

namespace fenestra::core {

namespace {

/// The piece of a Catmull-Rom curve between its nodes b (t = 0) and c (t = 1).
template <typename T>
class CurvePiece {
public:
  CurvePiece(const T& a, const T& b, const T& c, const T& d)
      : m_start(b),
        m_linear(0.5 * (c - a)),
        m_square(a - 2.5 * b + 2.0 * c - 0.5 * d),
        m_cube(0.5 * (d - a) + 1.5 * (b - c)) {}

  T at(double t) const { return m_start + t * (m_linear + t * (m_square + t * m_cube)); }

private:
  T m_start, m_linear, m_square, m_cube;
};

constexpr int tubePieces = 6; ///< per pair of nodes: enough to hide the corners

std::vector<TubeNode> refineTube(const std::vector<TubeNode>& nodes) {
  std::vector<TubeNode> result;
  const auto last = nodes.size() - 1;
  for (std::size_t i = 0; i < last; ++i) {
    const TubeNode& a = nodes[i == 0 ? 0 : i - 1];
    const TubeNode& d = nodes[std::min(i + 2, last)];
    const CurvePiece<Vec3> curve(a.point, nodes[i].point, nodes[i + 1].point, d.point);
    for (int piece = 0; piece < tubePieces; ++piece) {
      const double t = static_cast<double>(piece) / tubePieces;
      result.push_back({curve.at(t), std::lerp(nodes[i].radius, nodes[i + 1].radius, t)});
    }
  }
  result.push_back(nodes.back());
  return result;
}

double ellipseDistance(const Vec2& offset, const Vec2& radii, double squareness) {
  const Vec2 scaled = offset.cwiseQuotient(radii);
  const double round = scaled.norm();
  const double square = std::sqrt(scaled.array().square().matrix().norm());
  const double level = std::lerp(round, square, squareness);
  const double slope = scaled.cwiseQuotient(radii).norm() / std::max(round, 1e-9);
  return (level - 1.0) / std::max(slope, 1e-9);
}

Box uniteBoxes(const Box& a, const Box& b) {
  return {a.lower.cwiseMin(b.lower), a.upper.cwiseMax(b.upper)};
}

/// Bounding box of an affinely transformed box.
Box mapBox(const Affine& map, const Box& box) {
  Box result = Box::makeEmpty();
  for (int i = 0; i < 8; ++i)
    result.extend(map * box.corner(i));
  return result;
}

/// A loft between two of its sections.
struct LoftPiece {
  double bottom, height; ///< z
  CurvePiece<Vec2> center, radii;
};

std::vector<LoftPiece> makeLoftPieces(const std::vector<LoftSection>& sections) {
  std::vector<LoftPiece> pieces;
  const std::size_t last = sections.size() - 1;
  for (std::size_t i = 0; i < last; ++i) {
    const LoftSection& a = sections[i == 0 ? 0 : i - 1];
    const LoftSection& b = sections[i];
    const LoftSection& c = sections[i + 1];
    const LoftSection& d = sections[std::min(i + 2, last)];
    pieces.push_back({b.z,
                      c.z - b.z,
                      {a.center, b.center, c.center, d.center},
                      {a.radii, b.radii, c.radii, d.radii}});
  }
  return pieces;
}

LoftSection findSection(const std::vector<LoftPiece>& pieces, double z) {
  auto piece = pieces.begin();
  while (piece + 1 != pieces.end() && z > (piece + 1)->bottom)
    ++piece;
  const double t = std::clamp((z - piece->bottom) / piece->height, 0.0, 1.0);
  return {z, piece->center.at(t), piece->radii.at(t).cwiseMax(0.5)};
}

/// A tube between two of its nodes.
struct TubePiece {
  TubeNode start;
  Vec3 axis; ///< to the next node
  double squaredLength, endRadius;
};

std::vector<TubePiece> makeTubePieces(const std::vector<TubeNode>& nodes) {
  std::vector<TubePiece> pieces;
  for (std::size_t i = 0; i + 1 < nodes.size(); ++i) {
    const Vec3 axis = nodes[i + 1].point - nodes[i].point;
    pieces.push_back({nodes[i], axis, axis.squaredNorm(), nodes[i + 1].radius});
  }
  return pieces;
}

/// Distance to a tube with nodes as dense as refineTube() makes them.
double tubeDistance(const std::vector<TubePiece>& pieces, const Vec3& point) {
  double nearest = infinity;
  for (const TubePiece& piece : pieces) {
    const Vec3 offset = point - piece.start.point;
    const double t = std::clamp(offset.dot(piece.axis) / piece.squaredLength, 0.0, 1.0);
    const double radius = std::lerp(piece.start.radius, piece.endRadius, t);
    nearest = std::min(nearest, (offset - t * piece.axis).norm() - radius);
  }
  return nearest;
}

} // namespace

double smoothUnion(double a, double b, double blend) {
  const double h = std::max(blend - std::abs(a - b), 0.0);
  return std::min(a, b) - 0.25 * h * h / blend;
}

double smoothIntersection(double a, double b, double blend) {
  return -smoothUnion(-a, -b, blend);
}

double smoothDifference(double a, double b, double blend) {
  return smoothIntersection(a, -b, blend);
}

double ellipsoidDistance(const Vec3& point, const Vec3& center, const Vec3& radii) {
  const Vec3 scaled = (point - center).cwiseQuotient(radii);
  const double level = scaled.norm();
  const double slope = scaled.cwiseQuotient(radii).norm() / std::max(level, 1e-9);
  return (level - 1.0) / std::max(slope, 1e-9);
}

Solid makeEllipsoid(const Vec3& center, const Vec3& radii) {
  return {[=](const Vec3& p) { return ellipsoidDistance(p, center, radii); },
          {center - radii, center + radii}};
}

Solid makeBlock(const Vec3& halfSize, double radius) {
  return {[=](const Vec3& p) {
            const Vec3 beyond = p.cwiseAbs().array() - halfSize.array() + radius;
            return beyond.cwiseMax(0.0).norm() + std::min(beyond.maxCoeff(), 0.0) - radius;
          },
          {-halfSize, halfSize}};
}

Solid makeLoft(const std::vector<LoftSection>& sections, double squareness, double capBlend) {
  Box box = Box::makeEmpty();
  for (const LoftSection& section : sections)
    for (const double sign : {-1.0, 1.0}) {
      const Vec2 corner = section.center + sign * section.radii;
      box.extend({corner.x(), corner.y(), section.z});
    }
  const double bottom = sections.front().z, top = sections.back().z;
  const double overshoot = 2.0; // mm; of a Catmull-Rom curve beyond its nodes
  return {[=, pieces = makeLoftPieces(sections)](const Vec3& p) {
            const LoftSection section = findSection(pieces, p.z());
            const double side =
                ellipseDistance(p.head<2>() - section.center, section.radii, squareness);
            return smoothIntersection(side, std::max(bottom - p.z(), p.z() - top), capBlend);
          },
          expandBox(box, overshoot)};
}

Solid makeTube(const std::vector<TubeNode>& nodes, const Vec3& stretch) {
  Box box = Box::makeEmpty();
  std::vector<TubeNode> axis = refineTube(nodes); // in the space divided by the stretch
  for (TubeNode& node : axis) {
    box.extend(node.point - node.radius * stretch);
    box.extend(node.point + node.radius * stretch);
    node.point = node.point.cwiseQuotient(stretch);
  }
  return {[stretch, pieces = makeTubePieces(axis)](const Vec3& p) {
            return tubeDistance(pieces, p.cwiseQuotient(stretch));
          },
          box};
}

Affine toShape(const Vec3& origin, const Vec3& axis, const Vec3& up) {
  const Vec3 z = axis.normalized();
  const Vec3 y = (up - up.dot(z) * z).normalized();
  const Mat3 linear = Mat3::FromRows(z.cross(y), y, z);
  return Affine(linear, -(linear * origin));
}

Solid placeSolid(const Affine& toShape, const Solid& solid) {
  return {[=](const Vec3& p) { return solid.distance(toShape * p); },
          mapBox(toShape.inverse(), solid.box)};
}

/// The box grows by blend / 4, the maximum effect of a blend.
Solid unite(const Solid& a, const Solid& b, double blend) {
  return {[=](const Vec3& p) { return smoothUnion(a.distance(p), b.distance(p), blend); },
          expandBox(uniteBoxes(a.box, b.box), 0.25 * blend)};
}

Solid intersect(const Solid& a, const Solid& b, double blend) {
  return {[=](const Vec3& p) { return smoothIntersection(a.distance(p), b.distance(p), blend); },
          {a.box.lower.cwiseMax(b.box.lower), a.box.upper.cwiseMin(b.box.upper)}};
}

Solid subtract(const Solid& solid, const Solid& removed, double blend) {
  return {[=](const Vec3& p) {
            return smoothDifference(solid.distance(p), removed.distance(p), blend);
          },
          solid.box};
}

Solid mirrorPair(const Solid& right) {
  const Affine mirror(Mat3::Diagonal({-1.0, 1.0, 1.0}), Vec3::Zero());
  return unite(right, placeSolid(mirror, right), 0.1);
}

} // namespace fenestra::core
