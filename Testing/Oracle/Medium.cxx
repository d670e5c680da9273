#include "Medium.h"

namespace fenestra::oracle {
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

/// Trilinear sum of eight voxels; points outside the outermost voxel centers are clamped to them.
double Medium::scalarAtIndex(const Vec3& index) const {
  Size3 base;
  Vec3 fraction;
  for (int axis = 0; axis < 3; ++axis) {
    const double x = std::min(std::max(index[axis], 0.0), static_cast<double>(m_size[axis] - 1));
    base[axis] = static_cast<std::int64_t>(std::floor(x));
    fraction[axis] = x - std::floor(x);
  }
  double sum = 0.0;
  for (int corner = 0; corner < 8; ++corner) {
    double weight = 1.0;
    Size3 voxel = base;
    for (int axis = 0; axis < 3; ++axis) {
      const bool upper = corner >> axis & 1;
      weight *= upper ? fraction[axis] : 1.0 - fraction[axis];
      voxel[axis] = std::min(base[axis] + upper, m_size[axis] - 1);
    }
    const std::int64_t at = voxel[0] + m_size[0] * (voxel[1] + m_size[1] * voxel[2]);
    sum += weight * static_cast<double>(m_voxels[static_cast<std::size_t>(at)]);
  }
  return sum;
}

double Medium::extinction(const TransferFunction& transfer, const Vec3& world,
                          double scalar) const {
  const double sigma_t = interpolate(transfer.extinction, scalar)[0];
  if (!transfer.gradientOpacity || sigma_t == 0.0)
    return sigma_t;
  return sigma_t * interpolate(*transfer.gradientOpacity, gradient(world).norm())[0];
}

Vec3 Medium::gradient(const Vec3& world) const {
  const Vec3 index = m_worldToIndex * world;
  Vec3 perVoxel;
  for (int axis = 0; axis < 3; ++axis) {
    const Vec3 step = Vec3::Unit(axis);
    perVoxel[axis] = (scalarAtIndex(index + step) - scalarAtIndex(index - step)) / 2.0;
  }
  return m_worldToIndex.linear().transpose() * perVoxel; // chain rule
}

Vec3 Medium::spansPerMm(const Vec3& world) const {
  const auto& knots = m_transfer.extinction.knots();
  return gradient(world) / (knots.back().position - knots.front().position);
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

} // namespace fenestra::oracle
