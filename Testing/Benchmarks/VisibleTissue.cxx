#include "VisibleTissue.h"

#include "base/Text.h"
#include "model/volume/Field.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <functional>

namespace fenestra::core::benchmarks {
namespace {

/// The volume at world points.
class WorldField {
public:
  explicit WorldField(const Volume& volume) : m_volume(volume) {}

  /// Calls use(value), where value(world) interpolates the volume.
  template <typename Use>
  auto visit(const Use& use) const {
    return std::visit(
        [&](const auto& voxels) {
          const Field field(m_volume.grid, voxels);
          return use(
              [&](const Vec3& world) { return field.value(m_volume.grid.worldToIndex * world); });
        },
        m_volume.voxels);
  }

private:
  const Volume& m_volume;
};

/// True if the voxel at a world point is inside the mask.
bool isInside(const Mask& mask, const Vec3& world) {
  const Vec3 index = mask.grid.worldToIndex * world;
  Size3 voxel;
  for (int axis = 0; axis < 3; ++axis) {
    voxel[axis] = std::llround(index[axis]);
    if (voxel[axis] < 0 || voxel[axis] >= mask.grid.size[axis])
      return false;
  }
  return mask.voxels[linearIndex(voxel, mask.grid.size)] >= mask.threshold();
}

bool isInside(const std::optional<Mask>& mask, const Vec3& world) {
  return mask && isInside(*mask, world);
}

bool containsAny(const std::string& name, std::initializer_list<const char*> words) {
  const std::string lower = toLower(name);
  return std::ranges::any_of(
      words, [&](const char* word) { return lower.find(word) != std::string::npos; });
}

/// Masks of the segments by their names.
struct NamedTissues {
  std::optional<Mask> muscle = {}, heart = {}, lungs = {}, others = {};

  NamedTissues(const Segmentation* segmentation, const Grid& volume) {
    if (!segmentation)
      return;
    const std::vector<SegmentStatistics> statistics = segmentation->statistics();
    std::vector<SegmentInfo> muscles, hearts, lungParts, rest;
    for (std::size_t i = 0; i < statistics.size(); ++i) {
      const SegmentInfo& segment = segmentation->segments()[i];
      if (statistics[i].voxels == 0)
        continue;
      if (containsAny(segment.name, {"muscle", "glut", "iliopsoas", "autochthon"}))
        muscles.push_back(segment);
      else if (containsAny(segment.name, {"heart", "myocard"}))
        hearts.push_back(segment);
      else
        (containsAny(segment.name, {"lung"}) ? lungParts : rest).push_back(segment);
    }
    const auto unite = [&](const std::vector<SegmentInfo>& chosen) {
      return chosen.empty() ? std::nullopt : std::optional(segmentation->makeMask(chosen, volume));
    };
    muscle = unite(muscles);
    heart = unite(hearts);
    lungs = unite(lungParts);
    others = unite(rest);
  }

  /// True if there is a lung on both sides, to the right and to the left, within 120 mm.
  bool isBetweenLungs(const Vec3& world) const {
    const auto hasLung = [&](double side) {
      for (double step = 2.0; step <= 120.0; step += 2.0)
        if (isInside(lungs, world + side * step * Vec3::UnitX()))
          return true;
      return false;
    };
    return hasLung(1.0) && hasLung(-1.0);
  }
};

/// Offsets of 5x5x5 points within 3 mm along each axis.
std::vector<Vec3> makeWindow() {
  std::vector<Vec3> offsets;
  for (int z = -2; z <= 2; ++z)
    for (int y = -2; y <= 2; ++y)
      for (int x = -2; x <= 2; ++x)
        offsets.push_back(1.5 * Vec3(x, y, z));
  return offsets;
}

template <typename Value>
bool hasMuscleHu(const Value& value, const Vec3& world, const std::vector<Vec3>& window) {
  double sum = 0.0, outliers = 0.0;
  for (const Vec3& offset : window) {
    const double hu = value(world + offset);
    sum += hu;
    outliers += hu < -20.0 || hu > 150.0 ? 1.0 : 0.0;
  }
  const auto count = static_cast<double>(window.size());
  return sum >= 20.0 * count && sum <= 80.0 * count && outliers <= 0.05 * count;
}

bool isSurrounded(const Mask& mask, const Vec3& world, const std::vector<Vec3>& offsets) {
  return std::ranges::all_of(offsets,
                             [&](const Vec3& offset) { return isInside(mask, world + offset); });
}

/// Offsets of `radius` mm and half of it in 26 directions.
std::vector<Vec3> makeShells(double radius) {
  std::vector<Vec3> offsets;
  for (int z = -1; z <= 1; ++z)
    for (int y = -1; y <= 1; ++y)
      for (int x = -1; x <= 1; ++x)
        if (x != 0 || y != 0 || z != 0)
          for (const double part : {0.5, 1.0})
            offsets.push_back(part * radius * Vec3(x, y, z).normalized());
  return offsets;
}

double medianOf(std::vector<double> values) {
  return quantile(std::move(values), 0.5);
}

/// Median and scaled median absolute deviation of the volume deep inside a focus.
struct TissueRange {
  double median, deviation;
  std::size_t count;
};

TissueRange findRange(const Mask& focus, const std::function<double(const Vec3&)>& value) {
  const std::vector<Vec3> shells = makeShells(8.0);
  const Size3& size = focus.grid.size;
  std::vector<std::vector<double>> slices(static_cast<std::size_t>(size.z()));
  tbb::parallel_for(std::int64_t{0}, size.z(), [&](std::int64_t z) {
    for (std::int64_t y = 0; y < size.y(); ++y)
      for (std::int64_t x = 0; x < size.x(); ++x) {
        if (focus.voxels[linearIndex({x, y, z}, size)] < focus.threshold())
          continue;
        const Vec3 world = focus.grid.indexToWorld * Size3(x, y, z).cast<double>();
        if (isSurrounded(focus, world, shells))
          slices[static_cast<std::size_t>(z)].push_back(value(world));
      }
  });
  std::vector<double> values;
  for (const std::vector<double>& slice : slices)
    values.insert(values.end(), slice.begin(), slice.end());
  const double median = medianOf(values);
  std::vector<double> deviations = values;
  for (double& v : deviations)
    v = std::abs(v - median);
  return {median, 1.4826 * medianOf(deviations), values.size()};
}

/// Calls visit(world, inward) for each crossing of the 1/2 level on the edges between voxel
/// centers.
template <typename Visitor>
void forEachSurfacePoint(const Mask& mask, const Visitor& visit) {
  const Field field(mask.grid, mask.voxels);
  const Vec3 spacing = mask.grid.spacing();
  const double level = 0.5 * mask.maxValue;
  const Size3& size = mask.grid.size;
  for (std::int64_t z = 0; z < size.z(); ++z)
    for (std::int64_t y = 0; y < size.y(); ++y)
      for (std::int64_t x = 0; x < size.x(); ++x)
        for (int axis = 0; axis < 3; ++axis) {
          const Size3 from(x, y, z), to = from + Size3::Unit(axis);
          if (to[axis] >= size[axis])
            continue;
          const double a = mask.voxels[linearIndex(from, size)] - level;
          const double b = mask.voxels[linearIndex(to, size)] - level;
          if ((a < 0.0) == (b < 0.0))
            continue;
          const Vec3 index = from.cast<double>() + a / (a - b) * Vec3::Unit(axis);
          const Vec3 inward = field.gradient(index).normalized();
          const Vec3 edge = mask.grid.indexToWorld.linear() * Vec3::Unit(axis) / spacing[axis];
          visit(mask.grid.indexToWorld * index, inward, std::abs(inward.dot(edge)) / spacing[axis]);
        }
}

} // namespace

VisibleSurface::VisibleSurface(const PreparedScene& scene)
    : covered(scene.camera().width(), scene.camera().height()),
      depth(scene.camera().width(), scene.camera().height(), infinity) {
  const FeatureBuffers& features = *scene.features();
  for (std::size_t i = 0; i < features.hit.size(); ++i)
    if (features.hit[i] > 0.0F) {
      covered.values[i] = features.hit[i] >= 0.5F ? 1 : 0;
      depth.values[i] = features.depth[i] / features.hit[i];
    }
}

TissueRegions findTissueRegions(const PreparedScene& scene, const VisibleSurface& surface,
                                const PixelMask& focus, const Segmentation* segmentation) {
  const Camera& camera = scene.camera();
  const NamedTissues tissues(segmentation, scene.volume().grid);
  const std::vector<Vec3> window = makeWindow();
  const PixelMask jumps = dilate(findJumps(surface.depth, 3.0), 3.0);
  TissueRegions regions{
      subtract(focus, jumps), {camera.width(), camera.height()}, {camera.width(), camera.height()}};
  const auto classify = [&](const auto& value, int column, int row) {
    const Ray ray = camera.makeRay(column + 0.5, row + 0.5);
    const Vec3 world =
        ray.at(surface.depth.at(column, row) / camera.depthPerLength(ray)) + 3.0 * ray.direction;
    if (isInside(tissues.heart, world)) {
      regions.heart.at(column, row) = isSurrounded(*tissues.heart, world, window) ? 1 : 0;
    } else if (!isInside(tissues.others, world) && hasMuscleHu(value, world, window)) {
      const bool isHeart = !tissues.heart && tissues.isBetweenLungs(world);
      (isHeart ? regions.heart : regions.muscle).at(column, row) = 1;
    }
  };
  WorldField(scene.volume()).visit([&](const auto& value) {
    tbb::parallel_for(0, camera.height(), [&](int row) {
      for (int column = 0; column < camera.width(); ++column)
        if (surface.covered.at(column, row) != 0 && focus.at(column, row) == 0 &&
            jumps.at(column, row) == 0)
          classify(value, column, row);
    });
  });
  for (PixelMask* region : {&regions.focus, &regions.muscle, &regions.heart})
    *region = erode(*region, 2.0);
  return regions;
}

std::optional<double> measureForeignSurface(const Volume& volume, const Mask& focus) {
  return WorldField(volume).visit([&](const auto& value) -> std::optional<double> {
    const TissueRange range = findRange(focus, value);
    if (range.count < 200 || range.deviation > 60.0)
      return std::nullopt;
    constexpr double leastDeviation = 10.0; // HU
    const double limit = 3.5 * std::max(range.deviation, leastDeviation);
    double foreign = 0.0, all = 0.0;
    forEachSurfacePoint(focus, [&](const Vec3& world, const Vec3& inward, double area) {
      const double difference = std::abs(value(world + inward) - range.median);
      foreign += difference > limit ? area : 0.0;
      all += area;
    });
    return foreign / all;
  });
}

} // namespace fenestra::core::benchmarks
