#include "MatrixClips.h"

#include "clip/surface/ClippingSurface.h"

namespace fenestra::core::testing {
namespace {

/// Two balls, one of which has a cylindrical hole.
Mask makeFocus() {
  const Grid grid = makeCenteredGrid({17, 17, 17}, Vec3::Constant(0.75));
  Mask mask{grid, {}, 0, {"balls"}};
  for (int k = 0; k < 17; ++k)
    for (int j = 0; j < 17; ++j)
      for (int i = 0; i < 17; ++i) {
        const Vec3 p = grid.indexToWorld * Vec3(i, j, k);
        const Vec3 fromBall = p - Vec3(-1.5, 0.5, 0.0);
        const bool isBall = fromBall.norm() < 3.2 && fromBall.head<2>().norm() > 1.0;
        const bool isSmallBall = (p - Vec3(3.5, -1.0, 2.0)).norm() < 1.6;
        mask.voxels.push_back(isBall || isSmallBall ? 1 : 0);
        mask.count += mask.voxels.back();
      }
  return mask;
}

/// Describes Fenestra's exact surface by its depths at the samples. Between samples, in
/// silhouette cells, the oracle computes the depth itself.
void describeExact(const ClipDepth& surface, oracle::DepthClip& clip) {
  const DepthBuffer& buffer = *surface.buffer;
  for (std::int64_t i = 0; i < buffer.size(); ++i)
    clip.givenDepths.push_back(buffer.at(i));
  const SilhouetteCells& cells = *surface.silhouette;
  for (std::size_t i = 0; i < cells.indices().size(); ++i)
    if (const std::int32_t cell = cells.indices()[i]; cell >= 0) {
      clip.silhouettes[i] = {};
      if (const auto& [minimum, maximum] = cells.depthBounds()[static_cast<std::size_t>(cell)];
          cells.isInner(cell))
        clip.silhouettes[i] = {buffer.reference() + minimum, buffer.reference() + maximum};
    }
}

oracle::DepthClip describeDepth(const Combination& c, const ClippingSurface& surface,
                                const SurfaceOptions& options) {
  oracle::DepthClip clip;
  clip.isCutaway = c.clip == ClipFactor::cutaway;
  clip.focus = makeFocus();
  clip.smoothing = options.smoothing;
  clip.offset = options.offset;
  clip.edge = {options.edge.ghost, options.edge.softness};
  const DepthBuffer& buffer = *std::get<ClipDepth>(surface.clip).buffer;
  for (std::int64_t column = 0; column < buffer.columns(); ++column)
    clip.columns.push_back(buffer.position(column, 0).x());
  for (std::int64_t row = 0; row < buffer.rows(); ++row)
    clip.rows.push_back(buffer.position(0, row).y());
  for (const ControlPoint& point : surface.controlPoints) {
    clip.sites.push_back(point.site);
    clip.depths.push_back(point.depth);
  }
  if (c.clip == ClipFactor::hole)
    clip.hole = {static_cast<oracle::HoleDescription::Shape>(options.hole.shape),
                 options.hole.margin};
  if (c.clip == ClipFactor::exactSurface)
    describeExact(std::get<ClipDepth>(surface.clip), clip);
  return clip;
}

ClipEdge makeEdge(EdgeFactor factor) {
  const bool isGhost = factor == EdgeFactor::ghost || factor == EdgeFactor::softGhost;
  const bool isSoft = factor == EdgeFactor::soft || factor == EdgeFactor::softGhost;
  return {isGhost ? 0.25 : 0.0, isSoft ? 1.5 : 0.0};
}

SurfaceOptions makeSurfaceOptions(const Combination& c) {
  SurfaceOptions options;
  options.mode = c.clip == ClipFactor::cutaway ? SurfaceMode::cutaway
                 : c.clip == ClipFactor::hole  ? SurfaceMode::hole
                                               : SurfaceMode::surface;
  options.smoothing = c.index % 3 == 0 ? 0.95 : 0.5;
  options.boundary = c.clip == ClipFactor::exactSurface ? Boundary::exact : Boundary::spline;
  options.hole = {static_cast<HoleShape>(c.index % 3), 0.5};
  options.offset = c.offset;
  options.edge = makeEdge(c.edge);
  return options;
}

} // namespace

void placeClip(const Combination& c, Generator& generator, MatrixScene& scene) {
  TestScene& fenestra = scene.fenestra;
  const Camera camera(fenestra.pose, fenestra.width, fenestra.height);
  if (c.clip == ClipFactor::none)
    return;
  if (c.clip == ClipFactor::plane) {
    const Vec3 point = randomDirection(generator), normal = randomDirection(generator);
    const ClipEdge edge = makeEdge(c.edge);
    fenestra.clip = ClipPlane{camera, point, normal, edge};
    scene.clip = oracle::PlaneClip{point, normal, {edge.ghost, edge.softness}};
    return;
  }
  const SurfaceOptions options = makeSurfaceOptions(c);
  const ClippingSurface surface = buildClippingSurface(
      camera, Domain(fenestra.volume.grid, fenestra.crop), makeFocus(), options);
  fenestra.clip = surface.clip;
  scene.clip = describeDepth(c, surface, options);
  const auto& depths = std::get<ClipDepth>(surface.clip);
  const DepthBuffer& buffer = *depths.buffer;
  for (std::int64_t row = 0; row < buffer.rows(); ++row)
    for (std::int64_t column = 0; column < buffer.columns(); ++column)
      scene.fenestraDepths.push_back(depths.silhouette && surface.shown.isFocus(column, row)
                                         ? depths.surfaceDepth(buffer.position(column, row))
                                         : buffer.at(buffer.sample(column, row)));
}

void styleContext(StyleFactor factor, MatrixScene& scene) {
  if (factor == StyleFactor::none)
    return;
  const double extinction = factor == StyleFactor::desaturated ? 1.0 : 0.3;
  const double saturation = factor == StyleFactor::thin ? 1.0 : 0.2;
  scene.style = {makeFocus(), extinction, saturation};
  scene.fenestra.style = {std::make_shared<const Mask>(makeFocus()), extinction, saturation};
}

} // namespace fenestra::core::testing
