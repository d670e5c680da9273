#include "Medium.h"

#include <array>

namespace fenestra::core::oracle {
namespace {

template <int Channels>
auto interpolate(const PiecewiseLinear<Channels>& f, double s) {
  const auto& knots = f.knots();
  std::size_t right = 0; // first knot with position > s
  while (right < knots.size() && knots[right].position <= s)
    ++right;
  if (right == 0)
    return knots.front().value;
  if (right == knots.size())
    return knots.back().value;
  const auto& a = knots[right - 1];
  const auto& b = knots[right];
  const double fraction = (s - a.position) / (b.position - a.position);
  return typename PiecewiseLinear<Channels>::Value((1.0 - fraction) * a.value + fraction * b.value);
}

double findMaxKnot(const ScalarFunction& f) {
  double greatest = 0.0;
  for (const auto& knot : f.knots())
    greatest = std::max(greatest, knot.value[0]);
  return greatest;
}

struct Corner {
  Size3 voxel = {};
  double weight = 1.0;
};

/// Trilinear weights of the eight voxels around a point; points outside the outermost voxel centers
/// are clamped to them.
std::array<Corner, 8> findCorners(const Size3& size, const Vec3& index) {
  std::array<Corner, 8> corners;
  for (std::size_t corner = 0; corner < 8; ++corner) {
    Corner& found = corners[corner];
    for (int axis = 0; axis < 3; ++axis) {
      const double x = std::min(std::max(index[axis], 0.0), static_cast<double>(size[axis] - 1));
      const double fraction = x - std::floor(x);
      const bool upper = corner >> axis & 1;
      found.weight *= upper ? fraction : 1.0 - fraction;
      found.voxel[axis] =
          std::min(static_cast<std::int64_t>(std::floor(x)) + upper, size[axis] - 1);
    }
  }
  return corners;
}

std::vector<float> toFloats(const Voxels& voxels) {
  return std::visit([](const auto& v) { return std::vector<float>(v.begin(), v.end()); }, voxels);
}

} // namespace

Rgb evaluate(const ColorFunction& f, double s) {
  return interpolate(f, s);
}

double findMaxExtinction(const TransferFunction& transfer) {
  return findMaxKnot(transfer.extinction) *
         (transfer.gradientOpacity ? findMaxKnot(*transfer.gradientOpacity) : 1.0);
}

Medium::Medium(const Volume& volume, const TransferFunction& transfer,
               const std::optional<Affine>& crop)
    : m_size(volume.grid.size),
      m_worldToIndex(volume.grid.indexToWorld.inverse()),
      m_voxels(toFloats(volume.voxels)),
      m_transfer(transfer) {
  if (crop)
    m_worldToCrop = crop->inverse();
}

bool Medium::contains(const Vec3& world) const {
  const Vec3 index = m_worldToIndex * world;
  for (int axis = 0; axis < 3; ++axis)
    if (index[axis] < -0.5 || index[axis] > static_cast<double>(m_size[axis]) - 0.5)
      return false;
  return !m_worldToCrop || (*m_worldToCrop * world).cwiseAbs().maxCoeff() <= 1.0;
}

/// Voxels outside the volume repeat those of its border.
double Medium::scalarAtVoxel(const Size3& voxel) const {
  Size3 inside;
  for (int axis = 0; axis < 3; ++axis)
    inside[axis] = std::min(std::max<std::int64_t>(voxel[axis], 0), m_size[axis] - 1);
  const std::int64_t at = inside[0] + m_size[0] * (inside[1] + m_size[1] * inside[2]);
  return static_cast<double>(m_voxels[static_cast<std::size_t>(at)]);
}

double Medium::scalarAtIndex(const Vec3& index) const {
  double sum = 0.0;
  for (const auto& [voxel, weight] : findCorners(m_size, index))
    sum += weight * scalarAtVoxel(voxel);
  return sum;
}

double Medium::extinction(const TransferFunction& transfer, const Vec3& world,
                          double scalar) const {
  const double sigma_t = interpolate(transfer.extinction, scalar)[0];
  if (!transfer.gradientOpacity || sigma_t == 0.0)
    return sigma_t;
  const Vec3 perMm = m_worldToIndex.linear().transpose() * // chain rule
                     centralDifference(m_worldToIndex * world);
  return sigma_t * interpolate(*transfer.gradientOpacity, perMm.norm())[0];
}

Vec3 Medium::centralDifference(const Vec3& index) const {
  Vec3 perVoxel;
  for (int axis = 0; axis < 3; ++axis) {
    const Vec3 step = Vec3::Unit(axis);
    perVoxel[axis] = (scalarAtIndex(index + step) - scalarAtIndex(index - step)) / 2.0;
  }
  return perVoxel;
}

Vec3 Medium::sobelAtVoxel(const Size3& voxel) const {
  Vec3 perVoxel = Vec3::Zero();
  for (int x = -1; x <= 1; ++x)
    for (int y = -1; y <= 1; ++y)
      for (int z = -1; z <= 1; ++z) {
        // 1 2 1 across the derivative, -1 0 1 along it; the differences span two voxels.
        const double wx = 2 - x * x, wy = 2 - y * y, wz = 2 - z * z;
        perVoxel += scalarAtVoxel({voxel[0] + x, voxel[1] + y, voxel[2] + z}) / 32.0 *
                    Vec3(x * wy * wz, wx * y * wz, wx * wy * z);
      }
  return perVoxel;
}

Vec3 Medium::sobelDifference(const Vec3& index) const {
  Vec3 sum = Vec3::Zero();
  for (const auto& [voxel, weight] : findCorners(m_size, index))
    sum += weight * sobelAtVoxel(voxel);
  return sum;
}

Vec3 Medium::spansPerMm(const Vec3& world) const {
  const auto& knots = m_transfer.extinction.knots();
  const Vec3 index = m_worldToIndex * world;
  const Vec3 perVoxel = m_transfer.gradient == GradientKind::sobel ? sobelDifference(index)
                                                                   : centralDifference(index);
  return m_worldToIndex.linear().transpose() * perVoxel /
         (knots.back().position - knots.front().position);
}

double Medium::surfaceProbability(const TransferFunction& transfer, const Vec3& world,
                                  double slope) const {
  const double o = 1.0 - std::exp(-extinction(transfer, world, scalar(world)));
  return o * (1.0 - std::exp(-25.0 * std::pow(transfer.shading->gamma, 3.0) * slope));
}

Interval Medium::boxInterval(const Vec3& origin, const Vec3& direction) const {
  const Box box{Vec3::Constant(-0.5), m_size.cast<double>() - Vec3::Constant(0.5)};
  return intersectBox(box, transformRay(m_worldToIndex, {origin, direction}));
}

Interval intersectBox(const Box& box, const Ray& ray) {
  Interval part;
  for (int axis = 0; axis < 3; ++axis) {
    const double lower = box.lower[axis] - ray.origin[axis];
    const double upper = box.upper[axis] - ray.origin[axis];
    if (ray.direction[axis] == 0.0) {
      if (lower > 0.0 || upper < 0.0)
        return {0.0, 0.0};
      continue;
    }
    const double a = lower / ray.direction[axis], b = upper / ray.direction[axis];
    part.begin = std::max(part.begin, std::min(a, b));
    part.end = std::min(part.end, std::max(a, b));
  }
  return part;
}

} // namespace fenestra::core::oracle
