// Building what the lanes of WideTracker read.

#include "tracking/WideTracker.h"

#include <bit>

namespace fenestra {
namespace {

WideScene::DepthAxis wide(const DepthAxis& axis) {
  return {narrow(1.0 / axis.pitch),
          narrow(axis.start),
          static_cast<float>(axis.inside - 1),
          static_cast<float>(axis.before),
          narrow(1.0 / axis.factor),
          static_cast<float>(axis.size() - 1)};
}

/// Affine map of index space: `normal` in world space, times a world point, plus `offset`.
std::array<float, 4> row(const Grid& grid, const Vec3& normal, const Vec3& from, double offset) {
  const Vec3 n = grid.indexToWorld.linear().transpose() * normal;
  const double o = normal.dot(grid.indexToWorld.translation() - from) + offset;
  return {narrow(n.x()), narrow(n.y()), narrow(n.z()), narrow(o)};
}

/// The least half a float not below `majorant` whose last bit is as asked.
std::uint16_t upperHalf(float majorant, bool lastBit) {
  const auto whole = std::bit_cast<std::uint32_t>(majorant);
  std::uint32_t half = (whole >> 16) + ((whole & 0xffffU) != 0 ? 1U : 0U);
  half += (half & 1U) != (lastBit ? 1U : 0U) ? 1U : 0U;
  return static_cast<std::uint16_t>(half);
}

/// Of the number of empty cells around one, negated; never more of them.
std::uint16_t upperHalf(float minusAround) {
  return static_cast<std::uint16_t>(std::bit_cast<std::uint32_t>(minusAround) >> 16);
}

/// Gives empty cells inside the border the number of empty cells around them, negated: two sweeps
/// (Rosenfeld and Pfaltz 1966), exact for distances that count diagonals as 1. Nothing is known
/// beyond the border.
void findEmptyAround(const Size3& size, std::vector<float>& cells) {
  const auto index = [&](std::int64_t x, std::int64_t y, std::int64_t z) {
    return static_cast<std::size_t>(x + size.x() * (y + size.y() * z));
  };
  constexpr float unknown = -1e6F;
  const Size3 inner = size.array() - 1;
  const auto forEachInner = [&](auto&& visit) {
    for (std::int64_t z = 1; z < inner.z(); ++z)
      for (std::int64_t y = 1; y < inner.y(); ++y)
        for (std::int64_t x = 1; x < inner.x(); ++x)
          visit(x, y, z);
  };
  forEachInner([&](std::int64_t x, std::int64_t y, std::int64_t z) {
    float& cell = cells[index(x, y, z)];
    cell = cell > 0.0F ? cell : unknown;
  });
  // `side` is -1 for the neighbours that the first sweep has seen, 1 for the second's.
  const auto relax = [&](std::int64_t x, std::int64_t y, std::int64_t z, std::int64_t side) {
    float& cell = cells[index(x, y, z)];
    if (cell > 0.0F)
      return;
    // A full neighbour (positive) allows none, an empty one itself and as many as are around it.
    float around = -cell;
    const auto neighbour = [&](std::int64_t dx, std::int64_t dy, std::int64_t dz) {
      const float other = cells[index(x + dx, y + dy, z + dz)];
      around = std::min(around, other > 0.0F ? 0.0F : 1.0F - other);
    };
    for (std::int64_t dy = -1; dy <= 1; ++dy)
      for (std::int64_t dx = -1; dx <= 1; ++dx)
        neighbour(dx, dy, side);
    for (std::int64_t dx = -1; dx <= 1; ++dx)
      neighbour(dx, side, 0);
    neighbour(side, 0, 0);
    cell = -around;
  };
  forEachInner([&](auto x, auto y, auto z) { relax(x, y, z, -1); });
  forEachInner([&](auto x, auto y, auto z) {
    relax(size.x() - 1 - x, size.y() - 1 - y, size.z() - 1 - z, 1);
  });
}

WideScene::VoxelType typeOf(const Voxels& voxels) {
  return static_cast<WideScene::VoxelType>(voxels.index());
}

} // namespace

double setInside(RayBatch& rays, std::size_t i, const Domain& domain, const Ray& ray,
                 const Interval& range, std::uint32_t seed) {
  const Affine& worldToIndex = domain.grid().worldToIndex;
  const Ray indexRay = transformed(worldToIndex, ray);
  const Interval inside = domain.clip(indexRay, range);
  if (inside.empty()) {
    rays.set(i, {Vec3::Zero(), Vec3::Ones()}, 0.0, seed);
    return 0.0;
  }
  const Vec3 origin = inside.begin > 0.0 ? worldToIndex * ray.at(inside.begin) : indexRay.origin;
  rays.set(i, {origin, indexRay.direction}, inside.end - inside.begin, seed);
  return inside.begin;
}

bool WideTracker::serves(const Volume& volume, const TransferFunction& transfer) {
  constexpr double deepest = 1e4;
  const std::int64_t count = volume.grid.voxelCount();
  // Lanes address bytes of 16-bit voxels, else voxels, by 32 bits.
  const bool twoBytes = std::holds_alternative<std::vector<std::int16_t>>(volume.voxels) ||
                        std::holds_alternative<std::vector<std::uint16_t>>(volume.voxels);
  const std::int64_t most = std::int64_t{1} << (twoBytes ? 30 : 31);
  if (transfer.gradientOpacity || volume.grid.size.x() < 2 || count < 4 || count > most)
    return false;
  double greatest = 0.0;
  for (const auto& knot : transfer.extinction.knots())
    greatest = std::max(greatest, knot.value[0]);
  return greatest * 2.0 * volume.grid.boundingRadius() <= deepest;
}

WideTracker::WideTracker(const Volume& volume, const Domain& domain,
                         const TransferFunction& transfer, const MajorantGrid& majorants,
                         const Clip& clip) {
  m_scene.type = typeOf(volume.voxels);
  m_scene.voxels =
      std::visit([](const auto& v) { return static_cast<const void*>(v.data()); }, volume.voxels);
  m_scene.voxelCount = volume.grid.voxelCount();
  setCells(majorants, volume.grid);
  m_scene.extinction = WideTable(transfer.extinction);
  setDomain(domain);
  setClip(clip, volume.grid);
}

void WideTracker::setDomain(const Domain& domain) {
  const Box& box = domain.box();
  m_scene.lower = narrow3(box.lower);
  m_scene.upper = narrow3(box.upper);
  const Affine* toCrop = domain.toCrop();
  m_scene.cropped = toCrop != nullptr;
  if (toCrop)
    m_scene.toCrop = affineRows(*toCrop);
}

void WideTracker::setCells(const MajorantGrid& majorants, const Grid& grid) {
  const Size3& cells = majorants.cellCount();
  const Size3 bordered = cells.array() + 2;
  std::int64_t stride = 1;
  std::int64_t cellStride = 1;
  for (int axis = 0; axis < 3; ++axis) {
    const std::int64_t size = grid.size[axis];
    m_scene.axes[static_cast<std::size_t>(axis)] = {
        static_cast<float>(size - 1),
        static_cast<std::int32_t>(std::max<std::int64_t>(size - 2, 0)),
        static_cast<std::int32_t>(size > 1 ? stride : 0),
        static_cast<float>(majorants.edge()[axis]),
        narrow(1.0 / static_cast<double>(majorants.edge()[axis])),
        static_cast<std::int32_t>(cells[axis]),
        static_cast<std::int32_t>(cellStride)};
    stride *= size;
    cellStride *= bordered[axis];
  }
  std::vector<float> around(static_cast<std::size_t>(cellStride), 0.0F);
  m_scene.cells.assign(around.size() + 1, 0);
  for (std::int64_t z = 0; z < cells.z(); ++z)
    for (std::int64_t y = 0; y < cells.y(); ++y)
      for (std::int64_t x = 0; x < cells.x(); ++x) {
        const MajorantGrid::Cell& cell = majorants.cell(x + cells.x() * (y + cells.y() * z));
        const auto to =
            static_cast<std::size_t>(x + 1 + bordered.x() * (y + 1 + bordered.y() * (z + 1)));
        around[to] = cell.majorant;
        m_scene.cells[to] = cell.majorant > 0.0F ? upperHalf(cell.majorant, cell.cut) : 0;
      }
  findEmptyAround(bordered, around);
  for (std::size_t i = 0; i < around.size(); ++i)
    if (m_scene.cells[i] == 0)
      m_scene.cells[i] = upperHalf(around[i]);
}

void WideTracker::setClip(const Clip& clip, const Grid& grid) {
  if (std::holds_alternative<ClipNone>(clip))
    return;
  const auto setCamera = [&](const Camera& camera) {
    const Vec3& eye = camera.pose().position;
    m_scene.perspective = camera.pose().projection == Projection::perspective;
    m_scene.targetDepth = narrow(camera.targetDepth());
    m_scene.toView = {row(grid, camera.right(), eye, 0.0), row(grid, camera.up(), eye, 0.0),
                      row(grid, camera.forward(), eye, -camera.targetDepth())};
  };
  if (const auto* plane = std::get_if<ClipPlane>(&clip)) {
    m_scene.clipKind = WideScene::ClipKind::plane;
    setCamera(plane->camera);
    m_scene.toPlane = row(grid, plane->normal.normalized(), plane->point, 0.0);
    return;
  }
  const auto& depth = std::get<ClipDepth>(clip);
  m_scene.clipKind = depth.lookup == ClipDepth::Lookup::linear ? WideScene::ClipKind::depthLinear
                                                               : WideScene::ClipKind::depthNearest;
  setCamera(depth.camera);
  m_scene.depthX = wide(depth.buffer->xAxis());
  m_scene.depthY = wide(depth.buffer->yAxis());
  m_scene.depths = depth.buffer->depthsFromReference().data();
  m_scene.depthColumns = static_cast<std::int32_t>(depth.buffer->columns());
}

} // namespace fenestra
