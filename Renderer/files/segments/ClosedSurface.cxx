#include "files/segments/ClosedSurface.h"

#include "base/Error.h"
#include "files/segments/LabelLayers.h"
#include "files/segments/VtkSurface.h"
#include "io/InputRegistry.h"
#include "io/JsonNode.h"
#include "io/MessageText.h"
#include "model/masks/Voxelize.h"

#include <pugixml.hpp>

#include <span>
#include <string_view>

namespace fenestra::core {
namespace {

using Path = std::filesystem::path;
constexpr const char* exportHint =
    "export the segmentation in Slicer as a binary labelmap (.seg.nrrd)";

/// Paths of the files that a .vtm references. Throws Error (input) for files outside its folder.
std::vector<Path> readBlocks(const Path& path) {
  pugi::xml_document document;
  const std::string text = readText(path); // small: it only lists files
  const bool read = static_cast<bool>(document.load_buffer(text.data(), text.size()));
  const pugi::xml_node file = document.child("VTKFile");
  if (!read || std::string_view(file.attribute("type").value()) != "vtkMultiBlockDataSet")
    throw inputError(ErrorCode::damagedFile, path, "is damaged or not a multi-block file; ",
                     exportHint);
  constexpr std::size_t maxBlocks = 4096;
  std::vector<Path> blocks;
  for (const auto& block : file.child("vtkMultiBlockDataSet").children("DataSet")) {
    const Path name = Path(block.attribute("file").value()).lexically_normal();
    if (name.empty() || name.is_absolute() || *name.begin() == ".." || blocks.size() == maxBlocks)
      throw fieldError(path, "DataSet", "file=\"", sanitize(name.string()),
                       "\" is not in the folder of the .vtm; ", exportHint);
    blocks.push_back(path.parent_path() / name);
  }
  if (blocks.empty())
    throw inputError(path, "has no segment; ", exportHint);
  return blocks;
}

struct Surface {
  SegmentInfo info;
  VtkSurface shape;
};

SegmentInfo makeSegmentInfo(const VtkSurface& surface, std::size_t index) {
  const auto text = [&](const char* key, const std::string& fallback) {
    const auto found = surface.texts.find(key);
    return found == surface.texts.end() || found->second.empty() ? fallback : found->second;
  };
  SegmentInfo info;
  info.name = text("Segment_Name", "Segment " + std::to_string(index));
  info.id = text("Segment_ID", info.name);
  info.labelValue = static_cast<std::int32_t>(index + 1);
  info.parseTerminology(text("Segment_Tags", ""));
  for (const char* key : {"Segment_DefaultColor", "Segment_Color"}) {
    const auto found = surface.numbers.find(key);
    if (found != surface.numbers.end() && found->second.size() == 3)
      info.color = Rgb(found->second[0], found->second[1], found->second[2]).max(0.0).min(1.0);
  }
  return info;
}

std::vector<Surface> readSurfaces(const Path& path) {
  std::vector<Surface> surfaces;
  const std::set<std::string> fieldData = {"Segment_Name", "Segment_ID", "Segment_Tags",
                                           "Segment_DefaultColor", "Segment_Color"};
  MemoryBudget budget;
  for (const Path& block : readBlocks(path)) {
    VtkSurface shape = readVtkSurface(block, fieldData, budget);
    if (shape.triangles.empty() && shape.hasLines)
      throw fieldError(block, "Segmentation_MasterRepresentation",
                       "is planar contours, not a closed surface; ", exportHint);
    surfaces.push_back({makeSegmentInfo(shape, surfaces.size()), std::move(shape)});
  }
  return surfaces;
}

/// Bounds of the points, in a grid's index space.
Box computeBounds(const std::vector<Surface>& surfaces, const Affine& worldToIndex) {
  Box bounds{Vec3::Constant(infinity), Vec3::Constant(-infinity)};
  for (const Surface& surface : surfaces)
    for (const Vec3& point : surface.shape.points) {
      const Vec3 index = worldToIndex * point;
      bounds.lower = bounds.lower.cwiseMin(index);
      bounds.upper = bounds.upper.cwiseMax(index);
    }
  return bounds;
}

Grid makeGrid(const Box& bounds) {
  constexpr double voxelsAlongLongest = 256.0;
  const Vec3 extent = bounds.upper - bounds.lower;
  const double spacing = std::max(extent.maxCoeff() / voxelsAlongLongest, 1e-6);
  Affine indexToWorld = Affine::Identity();
  indexToWorld.linear() *= spacing;
  indexToWorld.translation() = bounds.lower;
  return {(extent / spacing).array().ceil().cast<std::int64_t>() + 1, indexToWorld};
}

/// Part of the reference grid that the surfaces can overlap.
Grid cropGrid(const Grid& reference, const Box& bounds) {
  const Vec3 last = reference.size.cast<double>().array() - 1.0;
  const Vec3 lower = bounds.lower.array().floor().max(0.0).min(last.array());
  const Vec3 upper = bounds.upper.array().ceil().max(0.0).min(last.array());
  Affine indexToWorld = reference.indexToWorld;
  indexToWorld.translate(lower);
  return {(upper - lower).array().cast<std::int64_t>().max(0) + 1, indexToWorld};
}

} // namespace

Segmentation readClosedSurfaces(const Path& path, const Grid* reference) {
  requireFile(path, "give a .vtm file in it");
  std::vector<Surface> surfaces = readSurfaces(path);
  const Box bounds = computeBounds(surfaces, Affine::Identity());
  if (!(bounds.upper.array() >= bounds.lower.array()).all())
    throw inputError(path, "has surfaces without points; ", exportHint);
  const Grid grid = reference
                        ? cropGrid(*reference, computeBounds(surfaces, reference->worldToIndex))
                        : makeGrid(bounds);
  LabelLayers layers(grid.size, path.string());
  std::vector<SegmentInfo> segments;
  for (Surface& surface : surfaces) {
    for (Vec3& point : surface.shape.points)
      point = grid.worldToIndex * point;
    const auto runs = voxelizeSurface(surface.shape.points, surface.shape.triangles, grid.size);
    if (!runs)
      throw inputError(path, "segment \"", sanitize(surface.info.name),
                       "\": has a surface with holes, or one too complex; ", exportHint);
    surface.info.layer = layers.add(*runs, static_cast<std::int16_t>(surface.info.labelValue));
    segments.push_back(surface.info);
  }
  const std::size_t layerCount = layers.count();
  return {path.string(), grid, layerCount, layers.takeInterleaved(), std::move(segments)};
}

std::vector<SegmentInfo> readClosedSurfaceInfos(const Path& path) {
  requireFile(path, "give a .vtm file in it");
  std::vector<SegmentInfo> infos;
  for (Surface& surface : readSurfaces(path))
    infos.push_back(std::move(surface.info));
  return infos;
}

} // namespace fenestra::core
