// Labels of a DICOM structure set: fills its contours.

#include "files/segments/DicomSegments.h"
#include "files/segments/LabelLayers.h"
#include "io/MessageText.h"
#include "model/masks/ContourFill.h"

#include <algorithm>
#include <array>

namespace fenestra::core {
namespace {

using Contour = std::vector<Vec3>;

/// Planes differ less than this in index space if they are the same, or a slice's.
constexpr double samePlane = 0.1;

struct Structure {
  std::vector<Contour> contours;         ///< RAS mm
  std::vector<ContourPlane> planes = {}; ///< in index space
  double gap = 0.0;                      ///< usual distance of its planes, in index space
};

/// Contours of at least three points; one or two points enclose nothing.
std::vector<Structure> readContours(const std::string& source, const DicomStructureSet& object) {
  std::vector<Structure> structures;
  for (const DicomRoi& roi : object.rois) {
    Structure& structure = structures.emplace_back();
    for (const std::vector<double>& numbers : roi.contours) {
      constexpr double maxLength = 1e9; // mm
      const bool isNear = std::ranges::all_of(
          numbers, [](double coordinate) { return std::abs(coordinate) < maxLength; });
      if (numbers.size() % 3 != 0 || !isNear)
        throw fieldError(source, "ContourData", "of \"", sanitize(roi.name),
                         "\" is no list of points in mm; export the structure set again");
      Contour contour;
      for (std::size_t i = 0; i < numbers.size(); i += 3)
        contour.push_back(lpsToRas * Vec3(numbers[i], numbers[i + 1], numbers[i + 2]));
      if (contour.size() >= 3)
        structure.contours.push_back(std::move(contour));
    }
  }
  if (std::ranges::all_of(structures, [](const auto& one) { return one.contours.empty(); }))
    throw inputError(ErrorCode::unsupportedFile, source,
                     "has no closed planar contours; export the structures as a SEG");
  return structures;
}

template <typename Use>
void forEachContour(const std::vector<Structure>& structures, const Use& use) {
  for (const Structure& structure : structures)
    for (const Contour& contour : structure.contours)
      use(contour);
}

Box computeBounds(const Contour& contour, const Affine& worldToIndex) {
  Box bounds = Box::makeEmpty();
  for (const Vec3& point : contour)
    bounds.extend(worldToIndex * point);
  return bounds;
}

bool isPlanar(const Box& bounds, int axis) {
  return bounds.upper[axis] - bounds.lower[axis] <= samePlane;
}

// ---- the grid

/// The volume's grid with its axes in cyclic order, so that the contours are in planes of constant
/// z; nullopt: no axis is normal to most contours.
std::optional<Grid> turnReference(const std::vector<Structure>& structures, const Grid& reference) {
  std::array<std::size_t, 3> planar{};
  std::size_t count = 0;
  forEachContour(structures, [&](const Contour& contour) {
    const Box bounds = computeBounds(contour, reference.worldToIndex);
    for (int axis = 0; axis < 3; ++axis)
      planar[static_cast<std::size_t>(axis)] += isPlanar(bounds, axis);
    ++count;
  });
  const auto z = static_cast<int>(std::ranges::max_element(planar) - planar.begin());
  if (2 * planar[static_cast<std::size_t>(z)] < count)
    return std::nullopt;
  const int x = (z + 1) % 3, y = (z + 2) % 3;
  const Mat3& steps = reference.indexToWorld.linear();
  return Grid(
      Size3(reference.size[x], reference.size[y], reference.size[z]),
      Affine(Mat3(steps.col(x), steps.col(y), steps.col(z)), reference.indexToWorld.translation()));
}

/// Twice the area of a contour times its unit normal (Newell's method).
Vec3 computeArea(const Contour& contour) {
  Vec3 area = Vec3::Zero();
  for (std::size_t i = 1; i + 1 < contour.size(); ++i)
    area += (contour[i] - contour[0]).cross(contour[i + 1] - contour[0]);
  return area;
}

/// Lower median of distances between different values; 0: there are none.
double findUsualGap(std::vector<double> values, double tolerance) {
  std::ranges::sort(values);
  std::vector<double> gaps;
  for (std::size_t i = 1; i < values.size(); ++i)
    if (const double gap = values[i] - values[i - 1]; gap > tolerance)
      gaps.push_back(gap);
  if (gaps.empty())
    return 0.0;
  const auto middle = gaps.begin() + static_cast<std::ptrdiff_t>((gaps.size() - 1) / 2);
  std::ranges::nth_element(gaps, middle);
  return *middle;
}

/// Axes whose third one is normal to the largest contour; voxels of 1 mm.
Affine makeAxes(const std::vector<Structure>& structures) {
  Vec3 largest = Vec3::Zero();
  forEachContour(structures, [&](const Contour& contour) {
    const Vec3 area = computeArea(contour);
    if (area.norm() > largest.norm())
      largest = area;
  });
  const Vec3 normal = largest.norm() > 0.0 ? largest.normalized() : Vec3::UnitZ();
  const Vec3 other = std::abs(normal.x()) < 0.6 ? Vec3::UnitX() : Vec3::UnitY();
  const Vec3 column = normal.cross(other).normalized();
  return Affine(Mat3(column.cross(normal), column, normal), Vec3::Zero());
}

/// A grid along the contours, as DicomSegments.h states; its size is chosen later.
Grid makeGrid(const std::vector<Structure>& structures, const Grid* reference) {
  Affine axes = makeAxes(structures);
  const Affine worldToAxes = axes.inverse();
  Box bounds = Box::makeEmpty();
  std::vector<double> depths;
  forEachContour(structures, [&](const Contour& contour) {
    for (const Vec3& point : contour)
      bounds.extend(worldToAxes * point);
    depths.push_back(computeBounds(contour, worldToAxes).center().z());
  });
  constexpr double usualVoxels = 128.0, maxVoxels = 512.0;
  const double extent = std::max((bounds.upper - bounds.lower).maxCoeff(), 1e-6);
  const double spacing = std::max(
      reference ? reference->spacing().minCoeff() : extent / usualVoxels, extent / maxVoxels);
  const double gap = findUsualGap(depths, 1e-3 * extent);
  const double step = gap > spacing ? gap / std::ceil(gap / spacing) : spacing;
  axes.translate(Vec3(bounds.lower.x(), bounds.lower.y(), std::ranges::min(depths)));
  const Mat3 steps = axes.linear() * Mat3::Diagonal(Vec3(spacing, spacing, step));
  return {Size3::Zero(), Affine(steps, axes.translation())};
}

// ---- planes

/// Sorts a structure's contours into planes of the grid. Returns false if one is not parallel.
bool sortContours(Structure& structure, const Grid& grid) {
  std::vector<std::pair<double, std::vector<Vec2>>> sorted;
  for (const Contour& contour : structure.contours) {
    const Box bounds = computeBounds(contour, grid.worldToIndex);
    if (!isPlanar(bounds, 2))
      return false;
    double z = bounds.center().z();
    if (std::abs(z - std::round(z)) <= samePlane)
      z = std::round(z);
    std::vector<Vec2> polygon;
    for (const Vec3& point : contour) {
      const Vec3 index = grid.worldToIndex * point;
      polygon.emplace_back(index.x(), index.y());
    }
    sorted.emplace_back(z, std::move(polygon));
  }
  std::ranges::stable_sort(sorted, {}, [](const auto& one) { return one.first; });
  for (auto& [z, polygon] : sorted) {
    if (structure.planes.empty() || z - structure.planes.back().z > 0.5 * samePlane)
      structure.planes.push_back({z});
    auto& polygons = structure.planes.back().polygons;
    if (std::ranges::find(polygons, polygon) == polygons.end()) // a repeated contour is no hole
      polygons.push_back(std::move(polygon));
  }
  return true;
}

std::vector<double> listDepths(const Structure& structure) {
  std::vector<double> depths;
  for (const ContourPlane& plane : structure.planes)
    depths.push_back(plane.z);
  return depths;
}

/// Sets each structure's usual gap: its own, else that of all structures, else one slice.
void setGaps(std::vector<Structure>& structures) {
  std::vector<double> gaps;
  for (const Structure& structure : structures)
    for (std::size_t i = 1; i < structure.planes.size(); ++i)
      gaps.push_back(structure.planes[i].z - structure.planes[i - 1].z);
  std::ranges::sort(gaps);
  const double usual = gaps.empty() ? 1.0 : gaps[(gaps.size() - 1) / 2];
  constexpr std::size_t minPlanes = 4; // fewer do not show what is usual
  for (Structure& structure : structures)
    structure.gap =
        structure.planes.size() < minPlanes ? usual : findUsualGap(listDepths(structure), 0.0);
}

/// Part of the grid that the structures can fill; a grid without size has no limits. Moves the
/// planes along.
Grid cropGrid(std::vector<Structure>& structures, const Grid& grid) {
  Box bounds = Box::makeEmpty();
  for (const Structure& structure : structures)
    for (const ContourPlane& plane : structure.planes)
      for (const std::vector<Vec2>& polygon : plane.polygons)
        for (const Vec2& point : polygon) {
          bounds.extend(Vec3(point.x(), point.y(), plane.z - 0.5 * structure.gap));
          bounds.extend(Vec3(point.x(), point.y(), plane.z + 0.5 * structure.gap));
        }
  const bool isLimited = grid.size.prod() > 0;
  const Vec3 last = isLimited ? Vec3(grid.size.cast<double>().array() - 1.0) : Vec3::Constant(1e5);
  const Vec3 first = isLimited ? Vec3::Zero() : Vec3::Constant(-1e5);
  const Vec3 lower = bounds.lower.array().floor().max(first.array()).min(last.array());
  const Vec3 upper = bounds.upper.array().ceil().max(first.array()).min(last.array());
  for (Structure& structure : structures)
    for (ContourPlane& plane : structure.planes) {
      plane.z -= lower.z();
      for (std::vector<Vec2>& polygon : plane.polygons)
        for (Vec2& point : polygon)
          point -= Vec2(lower.x(), lower.y());
    }
  Affine indexToWorld = grid.indexToWorld;
  indexToWorld.translate(lower);
  return {(upper - lower).array().cast<std::int64_t>().max(0) + 1, indexToWorld};
}

// ---- labels

/// Names of structures, for a warning.
class NameList {
public:
  void add(const SegmentInfo& segment) { m_names.push_back(sanitize(segment.name)); }
  bool isEmpty() const { return m_names.empty(); }
  std::string text() const { return join(m_names, ", ", {}, 12); }

private:
  std::vector<std::string> m_names;
};

/// Sorts all contours into planes; a structure with contours of another orientation stays empty.
void sortAll(std::vector<Structure>& structures, const Grid& grid, const std::string& source,
             const std::vector<SegmentInfo>& segments, std::vector<Message>& warnings) {
  NameList skipped;
  bool hasPlanes = false;
  for (std::size_t i = 0; i < structures.size(); ++i) {
    if (!sortContours(structures[i], grid)) {
      structures[i].planes.clear();
      skipped.add(segments[i]);
    }
    hasPlanes = hasPlanes || !structures[i].planes.empty();
  }
  if (!hasPlanes)
    throw inputError(ErrorCode::unsupportedFile, source,
                     "has no parallel contours; export the structures as a SEG");
  if (!skipped.isEmpty())
    warnings.push_back(makeMessage(ErrorCode::assumedGeometry, source, "contours of ",
                                   skipped.text(),
                                   " are not parallel to the others; they are left out"));
}

/// Widest gap between planes that is interpolated, in usual gaps.
constexpr double widestGap = 2.5;

/// Widest gap that is interpolated although it is not usual, in slices; 0: none.
double findSkippedGap(const Structure& structure) {
  double widest = 0.0;
  for (std::size_t i = 1; i < structure.planes.size(); ++i) {
    const double gap = structure.planes[i].z - structure.planes[i - 1].z;
    if (gap > 1.5 * structure.gap && gap <= widestGap * structure.gap)
      widest = std::max(widest, gap);
  }
  return widest;
}

} // namespace

Segmentation makeContourLabels(const std::string& source, const DicomStructureSet& object,
                               std::vector<SegmentInfo> segments, const Grid* reference) {
  std::vector<Structure> structures = readContours(source, object);
  std::optional<Grid> grid;
  if (reference)
    grid = turnReference(structures, *reference);
  if (!grid)
    grid = makeGrid(structures, reference);
  std::vector<Message> warnings;
  sortAll(structures, *grid, source, segments, warnings);
  setGaps(structures);
  const Grid cropped = cropGrid(structures, *grid);
  const Vec3 spacing = cropped.spacing();
  LabelLayers layers(cropped.size, source);
  NameList skipping;
  double skippedGap = 0.0;
  for (std::size_t i = 0; i < structures.size(); ++i) {
    const Structure& structure = structures[i];
    const auto runs = fillContours(structure.planes, cropped.size, {spacing.x(), spacing.y()},
                                   {widestGap * structure.gap, 0.5 * structure.gap});
    if (!runs)
      throw inputError(ErrorCode::limitExceeded, source, "contours of \"",
                       sanitize(segments[i].name),
                       "\" are too complex; export the structures as a SEG");
    segments[i].layer = layers.add(*runs, static_cast<LabelLayers::Label>(segments[i].labelValue));
    if (const double gap = findSkippedGap(structure); gap > 0.0) {
      skipping.add(segments[i]);
      skippedGap = std::max(skippedGap, gap);
    }
  }
  if (!skipping.isEmpty())
    warnings.push_back(makeMessage(
        ErrorCode::assumedGeometry, source, "contours of ", skipping.text(), " skip up to ",
        toString(skippedGap * spacing.z(), 4), " mm; the slices between them are interpolated"));
  const std::size_t layerCount = layers.count();
  Segmentation segmentation(source, cropped, layerCount, layers.takeInterleaved(),
                            std::move(segments));
  segmentation.addWarnings(warnings);
  return segmentation;
}

} // namespace fenestra::core
