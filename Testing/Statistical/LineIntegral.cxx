#include "LineIntegral.h"

namespace fenestra::core::testing {
namespace {

/// Roots of c1 + 2 c2 u + 3 c3 u^2 in (0, 1), and 0 and 1, sorted.
std::vector<double> splitMonotone(double c1, double c2, double c3) {
  std::vector<double> ends = {0.0, 1.0};
  const auto add = [&ends](double u) {
    if (u > 0.0 && u < 1.0)
      ends.push_back(u);
  };
  const double discriminant = c2 * c2 - 3.0 * c1 * c3;
  if (discriminant > 0.0) {
    const double q = -(c2 + std::copysign(std::sqrt(discriminant), c2));
    add(q / (3.0 * c3)); // of a quadratic or a line: infinite if there is no root
    add(c1 / q);
  }
  std::sort(ends.begin(), ends.end());
  return ends;
}

} // namespace

LineIntegral::LineIntegral(const Volume& volume, const TransferFunction& transfer)
    : m_worldToIndex(volume.grid.indexToWorld.inverse()), m_size(volume.grid.size) {
  std::visit([&](const auto& voxels) { m_scalars.assign(voxels.begin(), voxels.end()); },
             volume.voxels);
  for (const auto& knot : transfer.extinction.knots())
    m_knots.push_back({knot.position, knot.value.value()});
}

Interval LineIntegral::boxInterval(const Ray& ray) const {
  return boxInterval(m_worldToIndex * ray.origin, m_worldToIndex.linear() * ray.direction);
}

Interval LineIntegral::boxInterval(const Vec3& origin, const Vec3& direction) const {
  Interval range;
  for (int axis = 0; axis < 3; ++axis) {
    const double low = (-0.5 - origin[axis]) / direction[axis];
    const double high = (static_cast<double>(m_size[axis]) - 0.5 - origin[axis]) / direction[axis];
    range.begin = std::max(range.begin, std::min(low, high));
    range.end = std::min(range.end, std::max(low, high));
  }
  return range;
}

double LineIntegral::opticalDepth(const Ray& ray, const Interval& range) const {
  const Vec3 origin = m_worldToIndex * ray.origin;
  const Vec3 direction = m_worldToIndex.linear() * ray.direction;
  const Interval all = boxInterval(origin, direction);
  const double begin = std::max(all.begin, range.begin);
  const double end = std::min(all.end, range.end);
  if (!(begin < end))
    return 0.0;
  std::vector<double> breaks = {begin, end};
  for (int axis = 0; axis < 3; ++axis)
    for (std::int64_t plane = 0; plane < m_size[axis]; ++plane) {
      const double t = (static_cast<double>(plane) - origin[axis]) / direction[axis];
      if (t > begin && t < end)
        breaks.push_back(t);
    }
  std::sort(breaks.begin(), breaks.end());
  double sum = 0.0;
  for (std::size_t i = 0; i + 1 < breaks.size(); ++i)
    sum +=
        (breaks[i + 1] - breaks[i]) * meanExtinction(fitCubic(origin + breaks[i] * direction,
                                                              origin + breaks[i + 1] * direction));
  return sum;
}

double LineIntegral::interpolate(const Vec3& point) const {
  const Vec3 index = m_worldToIndex * point;
  return interpolateInCell(index, index);
}

/// Trilinear scalar at `index`, from the cell that contains `inCell`, so that both ends of a
/// segment use one cell. Constant beyond the outermost voxel centers.
double LineIntegral::interpolateInCell(const Vec3& index, const Vec3& inCell) const {
  double value = 0.0;
  for (int corner = 0; corner < 8; ++corner) {
    double weight = 1.0;
    std::int64_t voxel = 0;
    for (int axis = 2; axis >= 0; --axis) {
      const double last = static_cast<double>(m_size[axis]) - 1.0;
      const double low = std::floor(std::clamp(inCell[axis], 0.0, last));
      const double fraction = std::clamp(index[axis], 0.0, last) - low;
      const bool isUpper = (corner >> axis & 1) != 0;
      weight *= isUpper ? fraction : 1.0 - fraction;
      voxel = voxel * m_size[axis] +
              static_cast<std::int64_t>(std::min(low + (isUpper ? 1.0 : 0.0), last));
    }
    value += weight * m_scalars[static_cast<std::size_t>(voxel)];
  }
  return value;
}

LineIntegral::Cubic LineIntegral::fitCubic(const Vec3& from, const Vec3& to) const {
  double value[4];
  for (int n = 0; n < 4; ++n)
    value[n] = interpolateInCell(from + n / 3.0 * (to - from), 0.5 * (from + to));
  // Newton's divided differences at 0, 1/3, 2/3, 1, expanded in powers of u.
  const double d1 = 3.0 * (value[1] - value[0]);
  const double d2 = 4.5 * (value[2] - 2.0 * value[1] + value[0]);
  const double d3 = 4.5 * (value[3] - 3.0 * value[2] + 3.0 * value[1] - value[0]);
  return {value[0], d1 - d2 / 3.0 + 2.0 * d3 / 9.0, d2 - d3, d3};
}

/// Positions at which the scalar crosses a knot, by bisection.
void LineIntegral::addKnotCrossings(const Cubic& cubic, std::vector<double>& breaks) const {
  const std::vector<double> ends = splitMonotone(cubic.c1, cubic.c2, cubic.c3);
  for (std::size_t i = 0; i + 1 < ends.size(); ++i)
    for (const Knot& knot : m_knots) {
      double a = ends[i];
      double b = ends[i + 1];
      const bool isBelow = cubic(a) < knot.position;
      if (isBelow == (cubic(b) < knot.position))
        continue;
      for (int halving = 0; halving < 52; ++halving) {
        const double middle = 0.5 * (a + b);
        ((cubic(middle) < knot.position) == isBelow ? a : b) = middle;
      }
      breaks.push_back(b);
    }
}

/// Between crossings of knots, extinction is a cubic in u, so two-point Gauss quadrature is exact.
double LineIntegral::meanExtinction(const Cubic& cubic) const {
  std::vector<double> breaks = {0.0, 1.0};
  addKnotCrossings(cubic, breaks);
  std::sort(breaks.begin(), breaks.end());
  double sum = 0.0;
  for (std::size_t i = 0; i + 1 < breaks.size(); ++i) {
    const double half = 0.5 * (breaks[i + 1] - breaks[i]);
    const double middle = breaks[i] + half;
    const double offset = half / std::sqrt(3.0);
    sum += half * (extinction(cubic(middle - offset)) + extinction(cubic(middle + offset)));
  }
  return sum;
}

double LineIntegral::extinction(double scalar) const {
  if (scalar < m_knots.front().position)
    return m_knots.front().extinction;
  for (std::size_t i = 0; i + 1 < m_knots.size(); ++i) {
    const Knot& a = m_knots[i];
    const Knot& b = m_knots[i + 1];
    if (scalar < b.position)
      return a.extinction +
             (b.extinction - a.extinction) * (scalar - a.position) / (b.position - a.position);
  }
  return m_knots.back().extinction;
}

} // namespace fenestra::core::testing
