#include "model/masks/Voxelize.h"

#include <algorithm>
#include <tuple>
#include <utility>

namespace fenestra::core {
namespace {

struct Crossing {
  std::int64_t row = 0; ///< y + rows * z
  double x = 0.0;
};

bool isBefore(const Vec3& a, const Vec3& b) {
  return std::tie(a.y(), a.z()) < std::tie(b.y(), b.z());
}

/// Twice the signed area of the triangle (a, b, row) in the plane of y and z. computeEdgeArea(b, a)
/// is -computeEdgeArea(a, b), bit for bit.
double computeEdgeArea(const Vec3& a, const Vec3& b, double y, double z) {
  if (isBefore(b, a))
    return -computeEdgeArea(b, a, y, z);
  return (b.y() - a.y()) * (z - a.z()) - (b.z() - a.z()) * (y - a.y());
}

/// Side of the edge on which the row, perturbed as in Voxelize.h, lies: 1 or -1; 0 if the edge is a
/// single point.
int findEdgeSide(const Vec3& a, const Vec3& b, double area) {
  const auto sign = [](double x) { return (x > 0.0) - (x < 0.0); };
  if (area != 0.0)
    return sign(area);
  return b.z() != a.z() ? sign(a.z() - b.z()) : sign(b.y() - a.y());
}

/// First and last integer in [least, greatest] and in [0, size - 1]; first > last: none.
std::pair<std::int64_t, std::int64_t> findIntegers(double least, double greatest,
                                                   std::int64_t size) {
  const auto last = static_cast<double>(size - 1);
  return {static_cast<std::int64_t>(std::clamp(std::ceil(least), 0.0, last + 1.0)),
          static_cast<std::int64_t>(std::clamp(std::floor(greatest), -1.0, last))};
}

class Crossings {
public:
  explicit Crossings(const Size3& size) : m_size(size) {}

  /// Adds a triangle's intersections with rows. Returns false if maxWork is exceeded.
  bool add(const Vec3& a, const Vec3& b, const Vec3& c) {
    const auto [y0, y1] =
        findIntegers(std::min({a.y(), b.y(), c.y()}), std::max({a.y(), b.y(), c.y()}), m_size.y());
    const auto [z0, z1] =
        findIntegers(std::min({a.z(), b.z(), c.z()}), std::max({a.z(), b.z(), c.z()}), m_size.z());
    if (y1 < y0 || z1 < z0)
      return true;
    constexpr std::int64_t maxWork = 1'000'000'000;
    m_work += (y1 - y0 + 1) * (z1 - z0 + 1);
    if (m_work > maxWork)
      return false;
    for (std::int64_t z = z0; z <= z1; ++z)
      for (std::int64_t y = y0; y <= y1; ++y)
        addRow(a, b, c, y, z);
    return true;
  }

  std::vector<Crossing>& all() { return m_all; }

private:
  void addRow(const Vec3& a, const Vec3& b, const Vec3& c, std::int64_t row, std::int64_t slice) {
    const auto y = static_cast<double>(row), z = static_cast<double>(slice);
    const double weightC = computeEdgeArea(a, b, y, z), weightA = computeEdgeArea(b, c, y, z),
                 weightB = computeEdgeArea(c, a, y, z);
    const int side = findEdgeSide(a, b, weightC);
    if (side == 0 || findEdgeSide(b, c, weightA) != side || findEdgeSide(c, a, weightB) != side)
      return;
    const double area = weightA + weightB + weightC;
    const double x =
        area == 0.0 ? a.x() : (weightA * a.x() + weightB * b.x() + weightC * c.x()) / area;
    m_all.push_back({row + m_size.y() * slice, x});
  }

  Size3 m_size;
  std::int64_t m_work = 0;
  std::vector<Crossing> m_all;
};

} // namespace

std::optional<std::vector<VoxelRun>>
voxelizeSurface(const std::vector<Vec3>& points,
                const std::vector<std::array<std::uint32_t, 3>>& triangles, const Size3& size) {
  Crossings crossings(size);
  for (const auto& [a, b, c] : triangles)
    if (!crossings.add(points[a], points[b], points[c]))
      return std::nullopt;
  std::vector<Crossing>& all = crossings.all();
  std::sort(all.begin(), all.end(), [](const Crossing& a, const Crossing& b) {
    return std::tie(a.row, a.x) < std::tie(b.row, b.x);
  });
  std::vector<VoxelRun> runs;
  for (std::size_t i = 0; i < all.size(); i += 2) {
    if (i + 1 == all.size() || all[i + 1].row != all[i].row)
      return std::nullopt;
    const auto [first, last] = findIntegers(all[i].x, all[i + 1].x, size.x());
    if (first <= last)
      runs.push_back({all[i].row % size.y(), all[i].row / size.y(), first, last + 1});
  }
  return runs;
}

} // namespace fenestra::core
