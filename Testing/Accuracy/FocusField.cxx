#include "FocusField.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace fenestra::core::accuracy {

namespace {

constexpr std::uint8_t farthest = 12; ///< maximum empty radius, in cells
constexpr double rounding = 1e-14;    ///< rounding error of the field
constexpr double step = 1.0 / 16.0;   ///< step, in voxels along the ray's fastest axis

/// Bisection for the boundary between false (t = a) and true (t = b).
template <typename Predicate>
double bisect(double a, double b, const Predicate& predicate) {
  for (int i = 0; i < 48; ++i) {
    const double middle = 0.5 * (a + b);
    (predicate(middle) ? b : a) = middle;
  }
  return b;
}

/// Ternary search for the maximum of a function that is unimodal between a and b.
template <typename Function>
double findMaximum(double a, double b, const Function& f) {
  for (int i = 0; i < 80; ++i) {
    const double third = (b - a) / 3.0;
    if (f(a + third) <= f(b - third) + rounding)
      a += third;
    else
      b -= third;
  }
  return 0.5 * (a + b);
}

/// Next t at which a ray, at `index` for t, crosses a face between cells.
double findNextFace(const Vec3& index, const Vec3& direction, double t) {
  double least = infinity;
  for (int axis = 0; axis < 3; ++axis) {
    const double d = direction[axis], x = index[axis];
    const double face = d > 0.0 ? std::floor(x + 1e-9) + 1.0 : std::ceil(x - 1e-9) - 1.0;
    if (d != 0.0)
      least = std::min(least, t + (face - x) / d);
  }
  return least;
}

/// Minimum filter: replaces each value by the minimum of its 3 x 3 x 3 neighborhood.
void filterMinimum(std::vector<std::uint8_t>& values, const Size3& size) {
  const std::int64_t strides[] = {1, size.x(), size.x() * size.y()};
  std::vector<std::uint8_t> old;
  for (int axis = 0; axis < 3; ++axis) {
    old = values;
    const std::int64_t stride = strides[axis];
    for (std::int64_t i = 0; i < size.prod(); ++i) {
      const std::int64_t along = i / stride % size[axis];
      std::uint8_t least = old[static_cast<std::size_t>(i)];
      if (along > 0)
        least = std::min(least, old[static_cast<std::size_t>(i - stride)]);
      if (along + 1 < size[axis])
        least = std::min(least, old[static_cast<std::size_t>(i + stride)]);
      values[static_cast<std::size_t>(i)] = least;
    }
  }
}

} // namespace

FocusField::FocusField(const Indicator& indicator) {
  const Size3& size = indicator.size;
  const auto voxel = [&](std::int64_t x, std::int64_t y, std::int64_t z) {
    return indicator.voxels[static_cast<std::size_t>((z * size.y() + y) * size.x() + x)];
  };
  Size3 low = size, high = -Size3::Ones();
  const auto forVoxels = [&](const auto& visit) {
    for (std::int64_t z = 0; z < size.z(); ++z)
      for (std::int64_t y = 0; y < size.y(); ++y)
        for (std::int64_t x = 0; x < size.x(); ++x)
          if (voxel(x, y, z) >= 0.5 * indicator.full)
            visit(Size3(x, y, z));
  };
  forVoxels([&](const Size3& at) {
    low = low.cwiseMin(at);
    high = high.cwiseMax(at);
  });
  if ((high.array() < 0).any())
    throw std::runtime_error("the focus is empty");
  m_center = indicator.indexToWorld * (0.5 * (low + high).cast<double>());
  forVoxels([&](const Size3& at) {
    m_radius = std::max(m_radius, (indicator.indexToWorld * at.cast<double>() - m_center).norm());
  });
  low = (low - Size3::Constant(2)).cwiseMax(Size3::Zero());
  high = (high + Size3::Constant(2)).cwiseMin(size - Size3::Ones());
  m_size = high - low + Size3::Ones();
  m_cells = m_size + Size3::Ones();
  for (std::int64_t z = low.z(); z <= high.z(); ++z)
    for (std::int64_t y = low.y(); y <= high.y(); ++y)
      for (std::int64_t x = low.x(); x <= high.x(); ++x)
        m_fractions.push_back(voxel(x, y, z) / indicator.full);
  m_lower = Vec3::Constant(-0.5);
  m_upper = m_size.cast<double>() - Vec3::Constant(0.5);
  m_worldToIndex = (indicator.indexToWorld * makeTranslation(low.cast<double>())).inverse();
  computeEmptyRadii();
  m_longestEdge = indicator.indexToWorld.linear().columnNorms().maxCoeff();
}

void FocusField::computeEmptyRadii() {
  m_emptyRadius.assign(static_cast<std::size_t>(m_cells.prod()), farthest);
  for (std::int64_t z = 0; z < m_cells.z(); ++z)
    for (std::int64_t y = 0; y < m_cells.y(); ++y)
      for (std::int64_t x = 0; x < m_cells.x(); ++x)
        for (int corner = 0; corner < 8; ++corner) {
          const Size3 at = (Size3(x, y, z) - Size3(corner & 1, corner >> 1 & 1, corner >> 2))
                               .cwiseMax(Size3::Zero())
                               .cwiseMin(m_size - Size3::Ones());
          if (m_fractions[static_cast<std::size_t>((at.z() * m_size.y() + at.y()) * m_size.x() +
                                                   at.x())] >= 0.5)
            m_emptyRadius[static_cast<std::size_t>((z * m_cells.y() + y) * m_cells.x() + x)] = 0;
        }
  // After `farthest` rounds, each cell has its distance to the nearest cell with a weight >= 1/2.
  std::vector<std::uint8_t> minimum = m_emptyRadius;
  for (std::uint8_t round = 1; round < farthest; ++round) {
    filterMinimum(minimum, m_cells);
    for (std::size_t i = 0; i < minimum.size(); ++i)
      if (minimum[i] == 0 && m_emptyRadius[i] == farthest)
        m_emptyRadius[i] = round;
  }
}

std::size_t FocusField::cell(const Vec3& index) const {
  const Size3 at = (index.array() + 1.0).floor().matrix().cast<std::int64_t>();
  const Size3 in = at.cwiseMax(Size3::Zero()).cwiseMin(m_cells - Size3::Ones());
  return static_cast<std::size_t>((in.z() * m_cells.y() + in.y()) * m_cells.x() + in.x());
}

double FocusField::at(const Vec3& index) const {
  const Vec3 in = index.cwiseMax(Vec3::Zero()).cwiseMin((m_size - Size3::Ones()).cast<double>());
  const Size3 low = in.array().floor().matrix().cast<std::int64_t>();
  const Size3 high = (low + Size3::Ones()).cwiseMin(m_size - Size3::Ones());
  const Vec3 f = in - low.cast<double>();
  const auto voxel = [&](std::int64_t x, std::int64_t y, std::int64_t z) {
    return m_fractions[static_cast<std::size_t>((z * m_size.y() + y) * m_size.x() + x)];
  };
  const auto row = [&](std::int64_t y, std::int64_t z) {
    return (1.0 - f.x()) * voxel(low.x(), y, z) + f.x() * voxel(high.x(), y, z);
  };
  const auto layer = [&](std::int64_t z) {
    return (1.0 - f.y()) * row(low.y(), z) + f.y() * row(high.y(), z);
  };
  return (1.0 - f.z()) * layer(low.z()) + f.z() * layer(high.z());
}

double FocusField::findFirstHit(const Vec3& origin, const Vec3& direction) const {
  const Vec3 o = m_worldToIndex * origin;
  const Vec3 d = m_worldToIndex.linear() * direction;
  double t = 0.0, end = infinity;
  for (int axis = 0; axis < 3; ++axis)
    if (d[axis] != 0.0) {
      const double a = (m_lower[axis] - o[axis]) / d[axis], b = (m_upper[axis] - o[axis]) / d[axis];
      t = std::max(t, std::min(a, b));
      end = std::min(end, std::max(a, b));
    } else if (o[axis] < m_lower[axis] || o[axis] > m_upper[axis]) {
      return infinity;
    }
  const auto value = [&](double s) { return at(o + s * d); };
  const auto isInsideAt = [&](double s) { return value(s) >= 0.5; };
  const double voxel = 1.0 / d.cwiseAbs().maxCoeff(); // mm
  const double stride = step * voxel;
  // Steps end at cell faces, between which the field is smooth. A field that rises after one end of
  // a step and falls before the other may exceed 1/2 in between.
  const double near = 1e-6 * stride; // distance from an end at which its slope is examined
  const auto rises = [&](double from, double to) { return value(to) > from + rounding; };
  double here = value(t);
  if (t <= end && here >= 0.5)
    return t;
  while (t < end) {
    const Vec3 index = o + t * d;
    const double face = findNextFace(index, d, t);
    if (const std::uint8_t radius = m_emptyRadius[cell(o + 0.5 * (t + face) * d)]; radius > 0) {
      t = radius > 1 ? t + (radius - 1) * voxel : face;
      here = value(t);
      continue;
    }
    const double next = std::min({t + stride, face, end}), there = value(next);
    if (here > 0.25 && rises(here, t + near) && rises(there, next - near)) // else 1/2 is too far
      if (const double maximum = findMaximum(t, next, value); isInsideAt(maximum))
        return bisect(t, maximum, isInsideAt);
    if (there >= 0.5)
      return bisect(t, next, isInsideAt);
    t = next;
    here = there;
  }
  return infinity;
}

} // namespace fenestra::core::accuracy
