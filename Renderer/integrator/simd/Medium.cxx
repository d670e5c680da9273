// Construction of SimdTracker and its SimdMedium.

#include "integrator/simd/Tracker.h"

namespace fenestra::core {
namespace {

single::DepthTable toTable(const DepthAxis& axis) {
  return {narrow(1.0 / axis.pitch),
          narrow(axis.start),
          static_cast<float>(axis.inside - 1),
          static_cast<float>(axis.before),
          narrow(1.0 / axis.factor),
          static_cast<float>(axis.size() - 1)};
}

/// Row of an affine map from index space: normal . (world point - from) + offset. `normal` and
/// `from` are in world space.
AffineRow makeRow(const Grid& grid, const Vec3& normal, const Vec3& from, double offset) {
  const Vec3 n = grid.indexToWorld.linear().transpose() * normal;
  const double o = normal.dot(grid.indexToWorld.translation() - from) + offset;
  return {narrow(n.x()), narrow(n.y()), narrow(n.z()), narrow(o)};
}

/// Maximum number of voxels, along one axis, that 1 mm in any direction crosses.
double maxVoxelsPerMm(const Grid& grid) {
  return grid.worldToIndex.linear().transpose().columnNorms().maxCoeff();
}

SimdField makeField(const void* voxels, const Grid& grid) {
  return {voxels, grid.voxelCount(), makeSimdAxes(grid.size, grid.size)};
}

/// The extinction functions of the medium: one, or one per component.
std::vector<const ScalarFunction*> listExtinctions(const TransferFunction& transfer,
                                                   const Mixture* mixture) {
  if (!mixture)
    return {&transfer.extinction};
  std::vector<const ScalarFunction*> extinctions;
  for (const Component& component : mixture->components)
    extinctions.push_back(&component.transfer.extinction);
  return extinctions;
}

void setCells(SimdMedium& medium, const MajorantGrid& majorants, const Grid& grid) {
  medium.cells = SimdMajorants(majorants);
  const Size3& count = medium.cells.count;
  std::int64_t cellStride = 1;
  for (int axis = 0; axis < 3; ++axis) {
    const std::int64_t edge = medium.cells.merged * majorants.edge()[axis];
    medium.axes[static_cast<std::size_t>(axis)] = {
        static_cast<float>(edge), narrow(1.0 / static_cast<double>(edge)),
        std::nextafter(static_cast<float>(count[axis]), 0.0F), static_cast<float>(cellStride)};
    medium.firstCell += static_cast<float>(cellStride);
    cellStride *= count[axis] + 2;
  }
  medium.lastCell = static_cast<float>(medium.cells.codes.size() - 1);
  medium.overshoot = narrow(0.5 * MajorantGrid::margin / maxVoxelsPerMm(grid));
}

void setClip(SimdMedium& medium, const Clip& clip, const Grid& grid) {
  const auto* plane = std::get_if<ClipPlane>(&clip);
  const auto* depth = std::get_if<ClipDepth>(&clip);
  if (!plane && !depth)
    return;
  const ClipEdge& edge = plane ? plane->edge : depth->edge;
  medium.clip.ghost = narrow(edge.ghost);
  medium.clip.softness = narrow(edge.softness);
  medium.clip.perSoftness = narrow(edge.perSoftness());
  medium.cutSlope = edge.softness > 0.0 ? narrow(cutSlope) : 0.0F;
  const Camera& camera = plane ? plane->camera : depth->camera;
  const Vec3& from = camera.pose().position;
  medium.clip.isPerspective = camera.pose().projection == Projection::perspective ? 1 : 0;
  medium.clip.targetDepth = narrow(camera.targetDepth());
  medium.clip.toView = {makeRow(grid, camera.right(), from, 0.0),
                        makeRow(grid, camera.up(), from, 0.0),
                        makeRow(grid, camera.forward(), from, -camera.targetDepth())};
  medium.fromView = affineRows(Affine(Mat3(camera.right(), camera.up(), camera.forward())));
  if (plane) {
    medium.clipKind = SimdMedium::ClipKind::plane;
    medium.cutNormal = narrow3(-plane->normal.normalized());
    medium.toPlane = makeRow(grid, plane->normal.normalized(), plane->point, 0.0);
    return;
  }
  medium.clipKind = depth->lookup == ClipDepth::Lookup::linear ? SimdMedium::ClipKind::depthLinear
                                                               : SimdMedium::ClipKind::depthNearest;
  medium.cutNormal = narrow3(camera.forward());
  medium.clip.depthX = toTable(depth->buffer->xAxis());
  medium.clip.depthY = toTable(depth->buffer->yAxis());
  medium.depths = depth->buffer->depthsFromReference().data();
  medium.depthCount = depth->buffer->depthsFromReference().size();
  medium.depthColumns = static_cast<std::int32_t>(depth->buffer->columns());
  medium.silhouette = depth->silhouette.get();
}

void setContext(SimdMedium& medium, const ContextStyle& style, const Grid& grid) {
  const Mask& focus = *style.focus;
  medium.context = {makeField(focus.voxels.data(), focus.grid),
                    affineRows(focus.grid.worldToIndex * grid.indexToWorld),
                    0.5F * static_cast<float>(focus.maxValue), // indicator 1/2
                    narrow(style.extinction), narrow(style.saturation)};
}

} // namespace

double setDomainRay(RayBatch& rays, std::size_t i, const Domain& domain, const Ray& ray,
                    const Interval& range) {
  const Affine& worldToIndex = domain.grid().worldToIndex;
  const Ray indexRay = transformRay(worldToIndex, ray);
  const Interval inside = domain.clip(indexRay, range);
  if (inside.isEmpty()) {
    rays.set(i, {Vec3::Zero(), Vec3::Ones()}, 0.0);
    return 0.0;
  }
  const Vec3 origin = inside.begin > 0.0 ? worldToIndex * ray.at(inside.begin) : indexRay.origin;
  rays.set(i, {origin, indexRay.direction}, inside.end - inside.begin);
  return inside.begin;
}

bool SimdTracker::isSupported(const Volume& volume, const TransferFunction& transfer,
                              const Mixture* mixture) {
  constexpr double maxDepth = 1e5; // rounding moves a collision by at most 0.6 % of a free path
  // Voxels along the diagonal: a float's last place is then far below MajorantGrid::margin.
  constexpr double maxVoxels = 1 << 17;
  const std::int64_t count = volume.grid.voxelCount();
  constexpr std::int64_t maxCount = std::int64_t{1} << 31; // indices of 32 bits
  const std::int64_t minColumns = transfer.gradient == GradientKind::sobel ? 4 : 2; // of one load
  if (transfer.gradientOpacity || volume.grid.size.x() < minColumns || count < 4 ||
      count > maxCount || (mixture && !SimdMixture::isSupported(*mixture)))
    return false;
  const double diagonal = 2.0 * volume.grid.boundingRadius();
  double greatest = 0.0;
  for (const ScalarFunction* extinction : listExtinctions(transfer, mixture))
    for (const auto& knot : extinction->knots())
      greatest = std::max(greatest, knot.value[0]);
  return diagonal * maxVoxelsPerMm(volume.grid) <= maxVoxels && greatest * diagonal <= maxDepth;
}

SimdTracker::SimdTracker(const Volume& volume, const Domain& domain,
                         const TransferFunction& transfer, const MajorantGrid& majorants,
                         const Clip& clip, const ContextStyle* style, const StopFlag& stop,
                         const Mixture* mixture)
    : m_stop(stop) {
  const auto setVoxels = [&](const auto& voxels) {
    m_medium.voxels = voxels.data();
    m_medium.field = makeField(voxels.data(), volume.grid);
  };
  std::visit(setVoxels, volume.voxels);
  setCells(m_medium, majorants, volume.grid);
  m_medium.extinctions = SimdLines(listExtinctions(transfer, mixture));
  if (mixture)
    m_medium.mixture.emplace(*mixture, volume.grid);
  m_medium.lower = narrow3(domain.box().lower);
  m_medium.upper = narrow3(domain.box().upper);
  if (const Affine* toCrop = domain.toCrop())
    m_medium.toCrop = affineRows(*toCrop);
  setClip(m_medium, clip, volume.grid);
  if (style)
    setContext(m_medium, *style, volume.grid);
}

} // namespace fenestra::core
