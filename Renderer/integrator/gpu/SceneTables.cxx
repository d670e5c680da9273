#include "integrator/gpu/SceneTables.h"

#include "base/Sampler.h"
#include "clip/field/SilhouetteCells.h"
#include "clip/focus/FocusCells.h"

#include <bit>
#include <cstring>

namespace fenestra::core::gpu {
namespace {

AffineRow toRow(const std::array<float, 3>& v) {
  return {v[0], v[1], v[2], 0.0F};
}

/// `step` counts voxels: images are addressed by three indices.
VoxelAxis toVoxelAxis(const SimdAxis& axis) {
  return {axis.last, axis.lastCell, axis.last > 0.0F ? 1 : 0};
}

} // namespace

SceneTables::SceneTables(const SimdMedium& medium, const SimdShading& shading,
                         const CameraTable& camera, const CameraRays& cameraRays,
                         bool isStratified) {
  numbers.toLocal = shading.toLocal;
  numbers.localToIndex = shading.localToIndex;
  numbers.toGradient = shading.indexDifferenceToGradient;
  numbers.bounces = shading.bounces;
  numbers.surfaceRate = shading.surfaceRate;
  features.isHybrid = shading.hybrid ? 1 : 0;
  features.isSobel = shading.sobel ? 1 : 0;
  features.isCoated = shading.isCoated ? 1 : 0;
  features.wantNormals = shading.wantNormals ? 1 : 0;
  features.isStratified = isStratified ? 1 : 0;
  features.clipsCameraRays = !cameraRays.isUnclipped() && medium.clip.ghost == 0.0F ? 1 : 0;
  setLights(shading); // first: Lights.inl expects them at 0
  setVoxels(medium);
  setCells(medium);
  setFunctions(medium, shading);
  setLabels(medium, shading);
  setContext(medium);
  setMaps(shading);
  setCamera(camera);
  setClip(medium);
  numbers.nets = next();
  words.insert(words.end(), Sampler::nets.begin(), Sampler::nets.end());
}

Int SceneTables::append(float x) {
  return append(std::bit_cast<Int>(x));
}
Int SceneTables::append(Int x) {
  words.push_back(static_cast<std::uint32_t>(x));
  return next() - 1;
}
Int SceneTables::appendInts(std::span<const std::int32_t> numbers32) {
  const auto at = next();
  words.insert(words.end(), numbers32.begin(), numbers32.end());
  return at;
}
Int SceneTables::appendBytes(std::span<const std::uint8_t> bytes) {
  const auto at = next();
  words.resize(words.size() + bytes.size() / sizeof(UInt));
  std::memcpy(words.data() + at, bytes.data(), bytes.size());
  return at;
}
Int SceneTables::append(const std::array<float, 3>& v) {
  const Int at = append(v[0]);
  append(v[1]);
  append(v[2]);
  return at;
}

void SceneTables::setVoxels(const SimdMedium& medium) {
  features.voxelKind = static_cast<Int>(medium.voxels.index());
  numbers.voxelsX = toVoxelAxis(medium.field.axes[0]);
  numbers.voxelsY = toVoxelAxis(medium.field.axes[1]);
  numbers.voxelsZ = toVoxelAxis(medium.field.axes[2]);
  numbers.lower = toRow(medium.lower);
  numbers.upper = toRow(medium.upper);
  features.isCropped = medium.toCrop ? 1 : 0;
  if (medium.toCrop)
    numbers.toCrop = *medium.toCrop;
}

void SceneTables::setCells(const SimdMedium& medium) {
  const auto toAxis = [](const SimdMedium::Axis& axis) {
    return CellAxis{axis.cellEdge, axis.cellsPerVoxel, axis.insideCells, axis.cellStride};
  };
  numbers.cellsX = toAxis(medium.axes[0]);
  numbers.cellsY = toAxis(medium.axes[1]);
  numbers.cellsZ = toAxis(medium.axes[2]);
  numbers.firstCell = medium.firstCell;
  numbers.endCell = medium.lastCell;
  numbers.overshoot = medium.overshoot;
  numbers.cells = next();
  for (const std::int32_t code : medium.cells.codes)
    append(code);
}

void SceneTables::setFunctions(const SimdMedium& medium, const SimdShading& shading) {
  const SimdLines& table = medium.extinctions;
  numbers.lines = next();
  for (const SimdTable::Line& line : table.lines) {
    append(line.value);
    append(line.slope);
  }
  numbers.lineWords = 2 * table.count;
  numbers.lineStart = table.start;
  numbers.linesPerUnit = table.binsPerUnit;
  numbers.lastLine = table.last;
  numbers.extinctions = appendFunctions(table.segments);
  numbers.albedos = appendFunctions(shading.albedos);
  numbers.bsdfs = next();
  for (const SimdShading::BsdfNumbers& bsdf : shading.bsdfs)
    for (const float number : bsdf)
      append(number);
}

/// Appends the functions, then their headers (Medium.inl, findSegment). Returns the first header.
Int SceneTables::appendFunctions(const std::vector<SimdTable>& functions) {
  std::vector<std::array<Int, 4>> headers;
  for (const SimdTable& table : functions) {
    std::array<Int, 4> header = {next()};
    for (const float position : table.position)
      append(position);
    header[1] = next();
    for (const std::int32_t segment : table.binSegment)
      append(segment);
    header[2] = next();
    header[3] = 2 * static_cast<Int>(table.channels.front().size());
    for (const SimdTable::Channel& channel : table.channels)
      for (const SimdTable::Line& line : channel) {
        append(line.value);
        append(line.slope);
      }
    headers.push_back(header);
  }
  const auto first = next();
  for (std::size_t i = 0; i < functions.size(); ++i) {
    for (const Int offset : headers[i])
      append(offset);
    append(functions[i].binStart);
    append(functions[i].binsPerUnit);
    append(static_cast<float>(functions[i].binSegment.size() - 1));
  }
  return first;
}

void SceneTables::setLabels(const SimdMedium& medium, const SimdShading& shading) {
  const SimdLabelWeights* weights = shading.tint     ? &*shading.tint
                                    : medium.mixture ? &medium.mixture->weights
                                                     : nullptr;
  if (!weights)
    return;
  features.componentKind = medium.mixture ? 2 : 1;
  numbers.toWeights = weights->toWeights;
  const auto toAxis = [](const SimdAxis& axis) {
    return VoxelAxis{axis.last, axis.lastCell, axis.stride};
  };
  numbers.weightsX = toAxis(weights->axes[0]);
  numbers.weightsY = toAxis(weights->axes[1]);
  numbers.weightsZ = toAxis(weights->axes[2]);
  numbers.bricks = appendInts({weights->bricks, weights->brickCount});
  static_assert(sizeof(LabelWeights::Plane) == planeBytes);
  numbers.planes = appendBytes(
      {reinterpret_cast<const std::uint8_t*>(weights->planes), weights->planeCount * planeBytes});
  if (!medium.mixture)
    return;
  features.hasUnclipped = medium.mixture->hasUnclipped ? 1 : 0;
  numbers.mergedBricks = appendInts({medium.mixture->merged.bricks, weights->brickCount});
  numbers.unclipped = appendInts(medium.mixture->isUnclipped);
}

void SceneTables::setContext(const SimdMedium& medium) {
  if (!medium.context)
    return;
  const SimdMedium::Context& context = *medium.context;
  features.hasContext = 1;
  numbers.toFocus = context.toFocus;
  numbers.focusX = toVoxelAxis(context.focus.axes[0]);
  numbers.focusY = toVoxelAxis(context.focus.axes[1]);
  numbers.focusZ = toVoxelAxis(context.focus.axes[2]);
  numbers.focusLevel = context.level;
  numbers.contextExtinction = context.extinction;
  numbers.contextSaturation = context.saturation;
}

/// Members in the order of Maps.inl.
void SceneTables::setMaps(const SimdShading& shading) {
  std::vector<std::array<Int, 4>> tables; // offsets of texels, rows, columns and oneMinusCos
  const auto appendSlots = [&](const AliasTables& alias) {
    const Int at = next();
    for (const AliasTables::Slot& slot : alias.slots) {
      append(slot.threshold);
      append(slot.alias);
    }
    return at;
  };
  for (const EnvironmentTables& map : shading.maps) {
    const Int texels = next();
    for (std::int32_t i = 0; i < 3 * map.width * map.height; ++i)
      append(map.rgb[i]);
    const Int rows = appendSlots(map.rows), columns = appendSlots(map.columns);
    tables.push_back({texels, rows, columns, next()});
    for (const float number : map.oneMinusCos)
      append(number);
  }
  features.mapCount = static_cast<Int>(shading.maps.size());
  numbers.maps = next();
  for (std::size_t i = 0; i < tables.size(); ++i) {
    const EnvironmentTables& map = shading.maps[i];
    append(map.width);
    append(map.height);
    append(tables[i][0]);
    append(map.tint);
    append(map.pmf);
    append(map.pdfPerBrightness);
    append(map.rows.bits);
    append(tables[i][1]);
    append(map.columns.bits);
    append(tables[i][2]);
    append(tables[i][3]);
  }
}

/// Lists and members in the order of Lights.inl.
void SceneTables::setLights(const SimdShading& shading) {
  const LightTables<float>& lights = shading.lights;
  const auto three = [&](const auto& v) { append(std::array{v[0], v[1], v[2]}); };
  numbers.constantRed = lights.constant[0];
  numbers.constantGreen = lights.constant[1];
  numbers.constantBlue = lights.constant[2];
  features.hasSampledLights = shading.hasSampledLights ? 1 : 0;
  features.skyCount = static_cast<Int>(lights.skies.size());
  for (const auto& sky : lights.skies) {
    three(sky.up);
    three(sky.middle);
    three(sky.toTop);
    three(sky.toBottom);
  }
  features.areaCount = static_cast<Int>(lights.areas.size());
  for (const auto& light : lights.areas) {
    append(light.pmf);
    append(light.isDisk ? 1 : 0);
    three(light.center);
    three(light.normal);
    three(light.right);
    three(light.up);
    append(light.perRight);
    append(light.perUp);
    append(light.area);
    three(light.radiance);
  }
  features.directionalCount = static_cast<Int>(lights.directionals.size());
  for (const auto& light : lights.directionals) {
    append(light.pmf);
    three(light.toward);
    three(light.irradiance);
  }
  features.sphereCount = static_cast<Int>(lights.spheres.size());
  for (const auto& light : lights.spheres) {
    append(light.pmf);
    three(light.center);
    append(light.radius2);
    three(light.radiance);
  }
}

void SceneTables::setCamera(const CameraTable& camera) {
  numbers.point = toRow(camera.point);
  numbers.pointPerColumn = toRow(camera.pointPerColumn);
  numbers.pointPerRow = toRow(camera.pointPerRow);
  numbers.forward = toRow(camera.forward);
  numbers.forwardPerColumn = toRow(camera.forwardPerColumn);
  numbers.forwardPerRow = toRow(camera.forwardPerRow);
  numbers.middleColumn = camera.middleColumn;
  numbers.middleRow = camera.middleRow;
}

void SceneTables::setClip(const SimdMedium& medium) {
  features.clipKind = static_cast<Int>(medium.clipKind);
  numbers.clip = medium.clip;
  numbers.fromView = medium.fromView;
  numbers.toPlane = medium.toPlane;
  numbers.cutNormal = toRow(medium.cutNormal);
  numbers.cutSlope = medium.cutSlope;
  numbers.depths = next();
  numbers.depthColumns = medium.depthColumns;
  for (std::size_t i = 0; i < medium.depthCount; ++i)
    append(medium.depths[i]);
  if (medium.silhouette)
    setSilhouettes(*medium.silhouette);
}

void SceneTables::setSilhouettes(const SilhouetteCells& silhouettes) {
  features.hasSilhouettes = 1;
  numbers.silhouetteCells = appendInts(silhouettes.indices());
  numbers.silhouettes = next();
  const auto& bounds = silhouettes.depthBounds();
  for (std::size_t i = 0; i < bounds.size(); ++i) {
    append(bounds[i].min);
    append(bounds[i].max);
    append(silhouettes.isInner(static_cast<std::int32_t>(i)) ? 1 : 0);
  }
  numbers.surfaceOffset = narrow(silhouettes.offset());

  const FocusTracer& tracer = silhouettes.tracer();
  const Camera& camera = tracer.camera();
  Affine fromView = Affine(Mat3(camera.right(), camera.up(), camera.forward()));
  fromView.translation() = camera.pose().position + camera.targetDepth() * camera.forward();
  const FocusCells& cells = tracer.cells();
  numbers.viewToCells = affineRows(cells.worldToCell() * fromView);
  numbers.viewToIndex = affineRows(tracer.domain().grid().worldToIndex * fromView);
  numbers.isFocusInside = tracer.isFocusInside() ? 1 : 0;
  const Vec3 count = cells.box().upper;
  numbers.focusCellsX = narrow(count.x());
  numbers.focusCellsY = narrow(count.y());
  numbers.focusCellsZ = narrow(count.z());
  const FocusCells::Layout layout = cells.layout();
  numbers.focusBlocksX = static_cast<Int>(layout.blockCount.x());
  numbers.focusBlocksY = static_cast<Int>(layout.blockCount.y());
  numbers.focusBlocksZ = static_cast<Int>(layout.blockCount.z());
  numbers.focusBlocks =
      appendInts({layout.blocks, static_cast<std::size_t>(layout.blockCount.prod())});
  numbers.focusCorners = appendBytes({layout.corners, layout.count * 64});
  numbers.focusValues = layout.values ? appendBytes({layout.values, layout.count * 128}) : -1;
  numbers.focusScale = narrow(layout.valueScale);
}

} // namespace fenestra::core::gpu
