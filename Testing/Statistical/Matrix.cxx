#include "MatrixSegments.h"

#include <numeric>
#include <sstream>

namespace fenestra::core::testing {
namespace {

// ---- the design
// --------------------------------------------------------------------------------

/// Level of a factor in combination `index`.
int level(int factor, int index, int levels) {
  std::vector<int> order(static_cast<std::size_t>(levels));
  std::iota(order.begin(), order.end(), 0);
  Generator generator(static_cast<std::uint64_t>(1000 * factor + index / levels));
  for (std::size_t i = order.size() - 1; i > 0; --i) // a std::shuffle that is equal everywhere
    std::swap(order[i], order[generator() % (i + 1)]);
  return order[static_cast<std::size_t>(index % levels)];
}

Combination makeCombination(int index) {
  int factor = 0;
  const auto next = [&](int levels) { return level(++factor, index, levels); };
  constexpr double anisotropies[] = {-0.9, -0.4, 0.0, 0.3, 0.7, 0.9, 0.99};
  constexpr std::uint64_t unlimited = std::numeric_limits<std::uint64_t>::max();
  constexpr std::uint64_t bounces[] = {unlimited, unlimited, unlimited, 1, 3};
  const bool isSoftCut = index % 8 == 2;
  Combination c;
  c.index = index;
  c.view = static_cast<ViewFactor>(next(4));
  c.clip = static_cast<ClipFactor>(next(4)); // one of the first four
  c.light = static_cast<LightFactor>(next(6));
  c.g = anisotropies[next(7)];
  c.albedo = static_cast<AlbedoFactor>(next(6));
  c.transfer = static_cast<TransferFactor>(next(6));
  c.isHybrid = next(3) == 0 || isSoftCut;
  c.voxels = static_cast<VoxelFactor>(next(4));
  c.grid = static_cast<GridFactor>(next(5));
  c.isCropped = next(4) == 0;
  c.background = static_cast<BackgroundFactor>(next(3));
  c.bounces = bounces[next(5)];
  const int edge = next(4);
  const auto style = static_cast<StyleFactor>(std::max(0, next(6) - 2)); // one half: none
  constexpr double offsets[] = {0.0, 0.7, -0.7};
  const double offset = offsets[next(3)];
  const bool isVariantClip = next(2) == 0;
  const bool isVariantLight = next(3) == 0;
  const bool isCoated = next(2) == 0;
  constexpr int counts[] = {1, 3, 8};
  const int count = counts[next(3)];
  c.segments = static_cast<SegmentFactor>(next(3));
  c.hasSoftSegments = next(2) == 0;
  const bool isExtra = index >= shortCount && index % 3 != 0;
  c.segmentCount = index % 2 == 1 || isExtra ? count : 0;
  c.hasSegmentMedia = (next(2) == 0 && c.segmentCount > 0) || isExtra;
  if (next(2) == 0 && c.hasSegmentMedia) // surfaces of several kinds
    c.isHybrid = true;
  c.isCoated = isCoated && c.isHybrid;
  c.hasInterfaces = next(3) == 0 && c.hasSegmentMedia && c.isHybrid;
  if (index % 4 == 1 ||
      index % 4 == 2) { // the others stay simple, which shows errors of other factors best
    c.edge = static_cast<EdgeFactor>(isSoftCut ? 2 + edge % 2 : edge);
    c.style = style;
    c.offset = offset;
    if (isVariantClip && c.clip == ClipFactor::surface)
      c.clip = ClipFactor::exactSurface;
    if (isVariantClip && c.clip == ClipFactor::cutaway)
      c.clip = ClipFactor::hole;
  }
  c.gradient = static_cast<GradientKind>(next(2)); // last: earlier factors retain their levels
  if (isVariantLight && c.light == LightFactor::constant)
    c.light = LightFactor::sky;
  if (isVariantLight && c.light == LightFactor::disk)
    c.light = LightFactor::sphere;
  // Parallel light reaches the camera only through the phase function's peak: at g = 0.99 hardly
  // one path in ten thousand carries light, and means are far from normally distributed.
  const bool hasParallel = c.light == LightFactor::directional || c.light == LightFactor::several;
  if (hasParallel && c.g > 0.9)
    c.g = 0.9;
  return c;
}

// ---- the volume
// --------------------------------------------------------------------------------

Grid makeGrid(const Combination& c, Generator& generator) {
  const auto makeCentered = [](const Size3& size, const Mat3& axes) {
    Affine map = Affine::Identity();
    map.linear() = axes;
    map.translation() = -axes * (0.5 * (size.cast<double>() - Vec3::Ones()));
    return Grid(size, map);
  };
  const auto makeAxes = [](double x, double y, double z) {
    return Mat3(Mat3::Diagonal({x, y, z}));
  };
  switch (c.grid) {
  case GridFactor::cubes:
    return makeCentered({12, 11, 13}, makeAxes(1.0, 1.0, 1.0));
  case GridFactor::thickSlices:
    return makeCentered({24, 17, 4}, makeAxes(0.5, 0.7, 3.0));
  case GridFactor::rotated: {
    const Mat3 rotation =
        makeRotation(uniform(generator, 0.0, 6.0), randomDirection(generator)).linear();
    return makeCentered({14, 10, 12}, rotation * makeAxes(0.8, 1.2, 1.0));
  }
  case GridFactor::shearedMirrored: {
    Mat3 shear = Mat3::Identity();
    shear(0, 1) = 0.3;
    shear(1, 2) = -0.25;
    return makeCentered({11, 13, 9}, shear * makeAxes(1.0, -0.9, 1.3));
  }
  case GridFactor::fine: // majorant cells of several voxels
    return makeCentered({122, 115, 101}, makeAxes(0.1, 0.1, 0.12));
  }
  return {};
}

/// Smooth hills over world space, 0 to 1.
struct Hills {
  Vec3 a, b, c;

  explicit Hills(Generator& generator)
      : a(randomDirection(generator)),
        b(randomDirection(generator)),
        c(randomDirection(generator)) {}

  double operator()(const Vec3& p) const {
    const double sum =
        std::sin(0.7 * a.dot(p) + 1.0) + std::sin(1.3 * b.dot(p)) + std::sin(2.1 * c.dot(p) - 2.0);
    return 0.5 + sum / 6.0;
  }
};

struct Range {
  double low, high;
};

Range scalarRange(VoxelFactor voxels) {
  switch (voxels) {
  case VoxelFactor::uint8:
    return {5.0, 250.0};
  case VoxelFactor::int16:
    return {-1000.0, 2500.0};
  case VoxelFactor::uint16:
    return {1000.0, 60000.0};
  case VoxelFactor::float32:
    return {-0.25, 0.75};
  }
  return {};
}

template <typename Voxel>
Volume makeTypedVolume(const Grid& grid, const Range& range, Generator& generator) {
  const Hills hills(generator);
  return makeVolume<Voxel>(grid, [&](const Vec3& index) {
    const double noise = uniform(generator, -0.08, 0.08);
    const double u = std::clamp(hills(grid.indexToWorld * index) + noise, 0.0, 1.0);
    return range.low + u * (range.high - range.low);
  });
}

Volume makeCombinationVolume(const Combination& c, Generator& generator) {
  const Grid grid = makeGrid(c, generator);
  const Range range = scalarRange(c.voxels);
  switch (c.voxels) {
  case VoxelFactor::uint8:
    return makeTypedVolume<std::uint8_t>(grid, range, generator);
  case VoxelFactor::int16:
    return makeTypedVolume<std::int16_t>(grid, range, generator);
  case VoxelFactor::uint16:
    return makeTypedVolume<std::uint16_t>(grid, range, generator);
  case VoxelFactor::float32:
    return makeTypedVolume<float>(grid, range, generator);
  }
  return {};
}

// ---- the medium
// --------------------------------------------------------------------------------

/// Function with knots at relative positions, 0 to 1, within the scalar range.
ScalarFunction makeCurve(const Range& range, std::initializer_list<std::array<double, 2>> knots) {
  std::vector<ScalarFunction::Knot> placed;
  for (const auto& [u, value] : knots)
    placed.push_back({range.low + u * (range.high - range.low), ScalarFunction::Value(value)});
  return ScalarFunction(placed);
}

ScalarFunction makeExtinction(TransferFactor kind, const Range& range) {
  switch (kind) {
  case TransferFactor::step:
    return makeCurve(range, {{0.0, 0.02}, {0.5, 0.02}, {0.5, 2.5}, {1.0, 2.5}});
  case TransferFactor::spike:
    return makeCurve(range, {{0.0, 0.0}, {0.45, 0.0}, {0.5, 6.0}, {0.55, 0.0}, {1.0, 0.05}});
  case TransferFactor::nonMonotone:
    return makeCurve(range,
                     {{0.0, 0.3}, {0.25, 1.2}, {0.45, 0.0}, {0.6, 0.0}, {0.75, 1.8}, {1.0, 0.1}});
  case TransferFactor::linear:
  case TransferFactor::gradientOpacity:
  case TransferFactor::steepGradientOpacity:
    return makeCurve(range, {{0.0, 0.0}, {1.0, 2.0}});
  }
  return makeCurve(range, {{0.0, 0.0}});
}

ColorFunction makeAlbedo(AlbedoFactor kind, const Range& range) {
  const auto makeGray = [](double value) { return ColorFunction({{0.0, Rgb::Constant(value)}}); };
  switch (kind) {
  case AlbedoFactor::black:
    return makeGray(0.0);
  case AlbedoFactor::half:
    return makeGray(0.5);
  case AlbedoFactor::nearlyOne:
    return makeGray(0.999);
  case AlbedoFactor::one:
    return makeGray(1.0);
  case AlbedoFactor::perChannel:
    return ColorFunction({{0.0, Rgb(0.95, 0.6, 0.2)}});
  case AlbedoFactor::byScalar: {
    const double middle = range.low + 0.5 * (range.high - range.low);
    return ColorFunction({{range.low, Rgb(0.1, 0.3, 0.9)},
                          {middle, Rgb(0.9, 0.8, 0.4)},
                          {middle, Rgb(0.3, 0.9, 0.9)},
                          {range.high, Rgb(1.0, 0.9, 0.8)}});
  }
  }
  return makeGray(0.0);
}

TransferFunction makeTransfer(const Combination& c) {
  const Range range = scalarRange(c.voxels);
  const double span = range.high - range.low;
  TransferFunction transfer{makeExtinction(c.transfer, range), makeAlbedo(c.albedo, range)};
  transfer.g = c.g;
  const auto makeGradientCurve = [&](std::initializer_list<std::array<double, 2>> knots) {
    std::vector<ScalarFunction::Knot> placed; // positions in ranges per mm
    for (const auto& [slope, value] : knots)
      placed.push_back({slope * span, ScalarFunction::Value(value)});
    return ScalarFunction(placed);
  };
  if (c.transfer == TransferFactor::gradientOpacity)
    transfer.gradientOpacity = makeGradientCurve({{0.0, 0.2}, {0.3, 1.0}});
  if (c.transfer == TransferFactor::steepGradientOpacity)
    transfer.gradientOpacity = makeGradientCurve({{0.0, 0.0}, {0.1, 0.0}, {0.1, 1.0}, {0.3, 0.4}});
  transfer.gradient = c.gradient;
  if (c.isHybrid)
    transfer.shading = c.isCoated ? SurfaceShading::makeCoated(0.6, 0.35, c.g)
                                  : SurfaceShading{0.8, 0.3, 12.0, 0.6};
  return transfer;
}

// ---- lights, camera, crop, background
// -------------------------------------------------------------------------

EnvironmentMap makeMap(Generator& generator) {
  EnvironmentMap map{8, 4, {}};
  for (int i = 0; i < 8 * 4 * 3; ++i)
    map.rgb.push_back(static_cast<float>(std::max(0.0, uniform(generator, -0.3, 1.0))));
  for (int c = 0; c < 3; ++c) // a window
    map.rgb[static_cast<std::size_t>(3 * (8 + 5) + c)] = 2.5F;
  return map;
}

AreaLight makeAreaLight(AreaLight::Shape shape, LightFrame frame, Generator& generator) {
  // Lights in the camera's frame use the bounding sphere's radius as unit, about 10 mm.
  const double unit = frame == LightFrame::world ? 10.0 : 1.0;
  AreaLight light;
  light.shape = shape;
  light.center = 2.2 * unit * randomDirection(generator);
  light.normal = (-light.center.normalized() + 0.3 * randomDirection(generator)).normalized();
  light.up = randomDirection(generator);
  light.size = unit * Vec2(3.0, 2.0);
  light.radiance = Rgb(2.0, 1.6, 1.2);
  light.frame = frame;
  return light;
}

SkyLight makeSky(LightFrame frame, Generator& generator) {
  return {Rgb(0.2, 0.4, 1.4), Rgb(0.9, 1.0, 1.1), Rgb(0.5, 0.2, 0.0), randomDirection(generator),
          frame};
}

/// Sphere around a part of the volume, next to it, or far away.
SphereLight makeSphereLight(const Combination& c, LightFrame frame, Generator& generator) {
  const double unit = frame == LightFrame::world ? 10.0 : 1.0;
  constexpr double distances[] = {0.3, 0.9, 2.2};
  return {distances[c.index / 2 % 3] * unit * randomDirection(generator), 1.1 * unit,
          Rgb(2.0, 1.6, 1.2), frame};
}

std::vector<Light> makeLights(const Combination& c, Generator& generator) {
  const Light parallel = DirectionalLight{randomDirection(generator), Rgb(3.0, 2.5, 2.0)};
  const LightFrame frame = c.index % 2 == 0 ? LightFrame::world : LightFrame::camera;
  switch (c.light) {
  case LightFactor::constant:
    return {EnvironmentLight{Rgb(1.0, 0.9, 0.7), {}}};
  case LightFactor::map:
    return {EnvironmentLight{Rgb(1.0, 0.8, 1.2), makeMap(generator)}};
  case LightFactor::directional:
    return {parallel};
  case LightFactor::rectangle:
    return {makeAreaLight(AreaLight::Shape::rectangle, frame, generator)};
  case LightFactor::disk:
    return {makeAreaLight(AreaLight::Shape::disk, frame, generator)};
  case LightFactor::sky:
    return {makeSky(frame, generator), EnvironmentLight{Rgb(0.1, 0.1, 0.1), {}}};
  case LightFactor::sphere:
    return {makeSphereLight(c, frame, generator)};
  case LightFactor::several:
    return {EnvironmentLight{Rgb(0.2, 0.3, 0.4), {}},
            EnvironmentLight{Rgb(0.5, 0.5, 0.5), makeMap(generator)},
            parallel,
            makeAreaLight(AreaLight::Shape::rectangle, frame, generator),
            makeSky(frame, generator),
            makeSphereLight(c, frame, generator)};
  }
  return {};
}

CameraPose makePose(const Combination& c, Generator& generator) {
  CameraPose pose;
  const bool isPerspective =
      c.view == ViewFactor::perspective || c.view == ViewFactor::perspectiveInside;
  const bool wantsInside =
      c.view == ViewFactor::orthographicInside || c.view == ViewFactor::perspectiveInside;
  // A clipping surface requires a camera outside the volume.
  const bool isInside = wantsInside && (c.clip == ClipFactor::none || c.clip == ClipFactor::plane);
  pose.projection = isPerspective ? Projection::perspective : Projection::orthographic;
  pose.target = 1.5 * randomDirection(generator);
  pose.position = pose.target + (isInside ? 3.0 : 30.0) * randomDirection(generator);
  pose.up = randomDirection(generator);
  pose.scale = 8.0;
  pose.angle = isInside ? 70.0 : 30.0;
  return pose;
}

Affine makeCrop(Generator& generator) {
  Affine crop = Affine::Identity();
  crop.linear() = makeRotation(uniform(generator, 0.0, 6.0), randomDirection(generator)).linear() *
                  Mat3(Mat3::Diagonal({6.5, 4.5, 7.0}));
  crop.translation() = 0.5 * randomDirection(generator);
  return crop;
}

Background makeBackground(BackgroundFactor kind) {
  switch (kind) {
  case BackgroundFactor::color:
    return {Background::Kind::color, Rgb(0.2, 0.1, 0.3)};
  case BackgroundFactor::transparent:
    return {Background::Kind::transparent};
  case BackgroundFactor::environment:
    return {Background::Kind::environment};
  }
  return {};
}

} // namespace

std::vector<Combination> makeCombinations(int count) {
  std::vector<Combination> list;
  for (int i = 0; i < count; ++i)
    list.push_back(makeCombination(i));
  return list;
}

std::string describe(const Combination& c) {
  static constexpr const char* views[] = {"orthographic", "perspective", "orthographic inside",
                                          "perspective inside"};
  static constexpr const char* clips[] = {"no clip", "plane",         "cutaway",
                                          "surface", "exact surface", "hole"};
  static constexpr const char* edges[] = {"", ", ghost", ", soft", ", soft ghost"};
  static constexpr const char* styles[] = {"", ", thin context", ", desaturated context",
                                           ", thin desaturated context"};
  static constexpr const char* segments[] = {"overlapping", "nested", "disjoint"};
  static constexpr const char* lights[] = {"constant", "map",     "directional", "rectangle",
                                           "disk",     "several", "sky",         "sphere"};
  static constexpr const char* albedos[] = {"0", "0.5", "0.999", "1", "per channel", "by scalar"};
  static constexpr const char* transfers[] = {
      "linear", "step", "spike", "non-monotone", "gradient opacity", "steep gradient opacity"};
  static constexpr const char* voxels[] = {"uint8", "int16", "uint16", "float"};
  static constexpr const char* grids[] = {"cubes", "thick slices", "rotated", "sheared mirrored",
                                          "fine"};
  static constexpr const char* backgrounds[] = {"color", "transparent", "environment"};
  const auto name = [](const auto& names, auto kind) { return names[static_cast<int>(kind)]; };
  std::ostringstream text;
  text << name(views, c.view) << " | " << name(clips, c.clip);
  if (c.clip != ClipFactor::none)
    text << name(edges, c.edge);
  if (c.clip > ClipFactor::plane && c.offset != 0.0)
    text << (c.offset < 0.0 ? ", nearer" : ", deeper");
  if (c.segmentCount > 0)
    text << ", " << c.segmentCount << (c.hasSoftSegments ? " soft " : " hard ")
         << name(segments, c.segments) << (c.hasSegmentMedia ? " media" : " tints")
         << (c.hasInterfaces ? " with interfaces" : "");
  text << name(styles, c.style) << (c.isCropped ? ", cropped" : "") << " | "
       << name(lights, c.light) << " | " << c.g << " | " << name(albedos, c.albedo) << " | "
       << name(transfers, c.transfer) << (c.isHybrid ? c.isCoated ? ", coated" : ", hybrid" : "")
       << (c.isHybrid && c.gradient == GradientKind::sobel ? ", Sobel" : "") << " | "
       << name(voxels, c.voxels) << " | " << name(grids, c.grid) << " | "
       << name(backgrounds, c.background) << " | ";
  if (c.bounces == std::numeric_limits<std::uint64_t>::max())
    text << "any";
  else
    text << c.bounces;
  return text.str();
}

MatrixScene makeMatrixScene(const Combination& c) {
  Generator generator(static_cast<std::uint64_t>(77000 + c.index));
  Volume volume = makeCombinationVolume(c, generator);
  MatrixScene scene{
      {std::move(volume), makeTransfer(c), makeLights(c, generator), makePose(c, generator)}, {}};
  scene.settings.path.background = makeBackground(c.background);
  scene.settings.path.bounces = c.bounces;
  if (c.isCropped)
    scene.fenestra.crop = CropBox(makeCrop(generator));
  placeClip(c, generator, scene);
  styleContext(c.style, scene);
  placeSegments(c, generator, scene);
  return scene;
}

oracle::OracleScene MatrixScene::toOracleScene() const {
  std::optional<Affine> crop;
  if (fenestra.crop)
    crop = fenestra.crop->boxToWorld;
  return {fenestra.volume,
          fenestra.transfer,
          fenestra.lights,
          fenestra.pose,
          fenestra.width,
          fenestra.height,
          clip,
          crop,
          settings.path.background,
          settings.path.bounces,
          style,
          components};
}

} // namespace fenestra::core::testing
