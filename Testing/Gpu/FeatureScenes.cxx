#include "Gpu/GpuTesting.h"

namespace fenestra::core::testing {
namespace {

Combination makePlane() {
  Combination c =
      makeSimpleCombination(1, VoxelFactor::int16, GridFactor::rotated, LightFactor::directional);
  c.view = ViewFactor::perspectiveInside;
  c.clip = ClipFactor::plane;
  c.edge = EdgeFactor::soft;
  c.g = -0.4;
  c.transfer = TransferFactor::step;
  c.isHybrid = true;
  c.gradient = GradientKind::sobel;
  return c;
}

Combination makeCutaway() {
  Combination c =
      makeSimpleCombination(2, VoxelFactor::uint16, GridFactor::thickSlices, LightFactor::map);
  c.clip = ClipFactor::cutaway;
  c.g = 0.0;
  c.isHybrid = true;
  c.gradient = GradientKind::central;
  c.isCropped = true;
  return c;
}

Combination makeSurface() {
  Combination c = makeSimpleCombination(3, VoxelFactor::float32, GridFactor::shearedMirrored,
                                        LightFactor::rectangle);
  c.view = ViewFactor::perspective;
  c.clip = ClipFactor::exactSurface;
  c.edge = EdgeFactor::softGhost;
  c.isHybrid = true;
  c.isCoated = true;
  c.bounces = 3;
  return c;
}

Combination makeTint() {
  Combination c =
      makeSimpleCombination(4, VoxelFactor::int16, GridFactor::cubes, LightFactor::several);
  c.style = StyleFactor::thinDesaturated;
  c.segmentCount = 3;
  c.hasSoftSegments = true;
  return c;
}

Combination makeMixture() {
  Combination c =
      makeSimpleCombination(5, VoxelFactor::uint8, GridFactor::cubes, LightFactor::sphere);
  c.view = ViewFactor::perspective;
  c.clip = ClipFactor::surface;
  c.edge = EdgeFactor::soft;
  c.isHybrid = true;
  c.isCoated = true;
  c.segmentCount = 8;
  c.hasSegmentMedia = true;
  return c;
}

Combination makeHole() {
  Combination c =
      makeSimpleCombination(6, VoxelFactor::float32, GridFactor::fine, LightFactor::disk);
  c.clip = ClipFactor::hole;
  c.edge = EdgeFactor::ghost;
  c.style = StyleFactor::desaturated;
  c.transfer = TransferFactor::spike;
  return c;
}

std::vector<GpuScene> makeScenes() {
  Combination sky =
      makeSimpleCombination(0, VoxelFactor::uint8, GridFactor::cubes, LightFactor::sky);
  Combination unscattered =
      makeSimpleCombination(7, VoxelFactor::uint16, GridFactor::cubes, LightFactor::constant);
  sky.background = BackgroundFactor::environment;
  unscattered.bounces = 0;
  const std::pair<const char*, Combination> all[] = {{"sky", sky},
                                                     {"plane", makePlane()},
                                                     {"cutaway", makeCutaway()},
                                                     {"surface", makeSurface()},
                                                     {"tint", makeTint()},
                                                     {"mixture", makeMixture()},
                                                     {"hole", makeHole()},
                                                     {"unscattered", unscattered}};
  std::vector<GpuScene> scenes;
  for (const auto& [name, combination] : all) {
    MatrixScene made = makeMatrixScene(combination);
    made.settings.samples = 4;
    made.settings.path.wantNormals = combination.index % 2 == 0;
    made.settings.sampling =
        combination.index % 3 == 2 ? Sampling::independent : Sampling::stratified;
    scenes.push_back({name, std::move(made.fenestra), made.settings});
  }
  return scenes;
}

} // namespace

Combination makeSimpleCombination(int index, VoxelFactor voxels, GridFactor grid,
                                  LightFactor light) {
  Combination c;
  c.index = index;
  c.voxels = voxels;
  c.grid = grid;
  c.light = light;
  c.g = 0.3;
  c.albedo = AlbedoFactor::byScalar;
  c.bounces = std::numeric_limits<std::uint64_t>::max();
  return c;
}

const std::vector<GpuScene>& featureScenes() {
  static const std::vector<GpuScene> scenes = makeScenes();
  return scenes;
}

const GpuScene& findFeatureScene(const std::string& name) {
  return *std::ranges::find(featureScenes(), name, &GpuScene::name);
}

void expectSameBits(const Film& a, const Film& b) {
  const auto isSame = [](double x, double y) { return x == y || (std::isnan(x) && std::isnan(y)); };
  const auto areSame = [&](const auto& x, const auto& y) {
    return isSame(x[0], y[0]) && isSame(x[1], y[1]) && isSame(x[2], y[2]);
  };
  ASSERT_EQ(a.pixelCount(), b.pixelCount());
  for (std::size_t i = 0; i < a.pixelCount(); ++i) {
    const PixelSums& p = a.pixels()[i];
    const PixelSums& q = b.pixels()[i];
    ASSERT_TRUE(p.samples == q.samples && p.isDeterministic == q.isDeterministic) << i;
    ASSERT_TRUE(areSame(p.mean, q.mean) && areSame(p.m2, q.m2))
        << i << ": " << p.mean[0] << ", " << q.mean[0];
    ASSERT_TRUE(isSame(p.alpha, q.alpha) && isSame(p.depth, q.depth)) << i;
    ASSERT_TRUE(p.collidedSamples == q.collidedSamples && p.scatterings == q.scatterings) << i;
    ASSERT_TRUE(areSame(p.albedo, q.albedo) && areSame(p.normal, q.normal)) << i;
    ASSERT_TRUE(areSame(p.evenMean, q.evenMean) && areSame(p.blockM2, q.blockM2)) << i;
  }
}

} // namespace fenestra::core::testing
