#include "BoundaryMeasure.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace fenestra::core::accuracy {

namespace {

constexpr std::size_t raysAcrossPixel = 4;

/// Hash of an integer to [0, 1) (splitmix64).
double jitter(std::uint64_t number) {
  std::uint64_t x = (number + 1) * 0x9e3779b97f4a7c15ULL;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ULL;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebULL;
  return static_cast<double>((x ^ (x >> 31)) >> 11) * 0x1p-53;
}

/// The four pixel centers around a raster position; `first`: index of the top left one.
struct Cell {
  std::size_t first;

  Cell(const Vec2& raster, int size) {
    const double last = size - 1.0;
    const double column = std::clamp(raster.x() - 0.5, 0.0, last);
    const double row = std::clamp(raster.y() - 0.5, 0.0, last);
    const double left = std::min(std::floor(column), last - 1.0);
    const double top = std::min(std::floor(row), last - 1.0);
    first = static_cast<std::size_t>(top) * static_cast<std::size_t>(size) +
            static_cast<std::size_t>(left);
  }
};

Distances summarize(std::vector<double> values) {
  Distances result;
  if (values.empty())
    return result;
  std::ranges::sort(values);
  for (const double value : values) {
    result.mean += value / static_cast<double>(values.size());
    result.wideFraction += (value > wideGap ? 1.0 : 0.0) / static_cast<double>(values.size());
  }
  result.p95 = values[static_cast<std::size_t>(0.95 * static_cast<double>(values.size() - 1))];
  result.max = values.back();
  return result;
}

} // namespace

FocusView::FocusView(const FocusField& field, const View& view)
    : m_field(field), m_view(view), m_width(raysAcrossPixel * static_cast<std::size_t>(view.size)) {
  traceRays();
  traceOutline();
}

double FocusView::focusDepth(const Vec2& raster) const {
  const View::CameraRay ray = m_view.cameraRay(raster);
  return ray.depthPerLength * m_field.findFirstHit(ray.origin, ray.direction);
}

Vec2 FocusView::rasterPosition(std::size_t ray) const {
  const auto column = static_cast<double>(ray % m_width);
  const auto row = static_cast<double>(ray / m_width);
  return Vec2(column + jitter(2 * ray), row + jitter(2 * ray + 1)) / double{raysAcrossPixel};
}

void FocusView::traceRays() {
  const auto size = static_cast<std::size_t>(m_view.size);
  m_centers.resize(size * size);
  tbb::parallel_for(std::size_t{0}, size, [&](std::size_t row) {
    for (std::size_t column = 0; column < size; ++column)
      m_centers[row * size + column] =
          focusDepth(Vec2(static_cast<double>(column) + 0.5, static_cast<double>(row) + 0.5));
  });
  m_rays.resize(m_width * m_width);
  tbb::parallel_for(std::size_t{0}, m_width, [&](std::size_t row) {
    for (std::size_t ray = row * m_width; ray < (row + 1) * m_width; ++ray)
      m_rays[ray] = focusDepth(rasterPosition(ray));
  });
}

void FocusView::traceOutline() {
  m_outlineDepths.resize(m_rays.size(), {infinity, -infinity});
  const auto compare = [&](std::size_t a, std::size_t b) {
    const bool aIn = m_rays[a] < infinity, bIn = m_rays[b] < infinity;
    if (aIn == bIn)
      return;
    m_outline.push_back(aIn ? findEdge(a, b) : findEdge(b, a));
    const Point& end = m_outline.back().inner;
    DepthRange& range = m_outlineDepths[findNearestRay(end.raster)];
    range = {std::min(range.least, end.depth), std::max(range.greatest, end.depth)};
  };
  for (std::size_t row = 0; row + 1 < m_width; ++row)
    for (std::size_t column = 0; column + 1 < m_width; ++column) {
      const std::size_t ray = row * m_width + column;
      compare(ray, ray + 1);
      compare(ray, ray + m_width);
    }
}

/// Ray of the subpixel that contains a raster position.
std::size_t FocusView::findNearestRay(const Vec2& raster) const {
  const auto subpixel = [&](double x) {
    return std::min(static_cast<std::size_t>(x * double{raysAcrossPixel}), m_width - 1);
  };
  return subpixel(raster.y()) * m_width + subpixel(raster.x());
}

FocusView::Edge FocusView::findEdge(std::size_t in, std::size_t out) const {
  Point inner{rasterPosition(in), m_rays[in]};
  Vec2 outer = rasterPosition(out);
  for (int i = 0; i < 24; ++i) {
    const Vec2 middle = 0.5 * (inner.raster + outer);
    if (const double depth = focusDepth(middle); depth < infinity)
      inner = {middle, depth};
    else
      outer = middle;
  }
  return {inner, outer};
}

bool FocusView::isAtJump(const Point& point) const {
  const auto size = static_cast<std::size_t>(m_view.size);
  const Cell cell(point.raster, m_view.size);
  double least = point.depth, greatest = point.depth;
  for (const std::size_t step : {std::size_t{0}, std::size_t{1}, size, size + 1})
    if (const double depth = m_centers[cell.first + step]; depth < infinity) {
      least = std::min(least, depth);
      greatest = std::max(greatest, depth);
    }
  return greatest - least > jumpDepth;
}

bool FocusView::isAtOutlineJump(const Point& point) const {
  const std::size_t ray = findNearestRay(point.raster);
  const std::size_t column = ray % m_width, row = ray / m_width;
  double least = infinity, greatest = -infinity;
  for (std::size_t r = std::max<std::size_t>(row, 1) - 1; r <= std::min(row + 1, m_width - 1); ++r)
    for (std::size_t c = std::max<std::size_t>(column, 1) - 1;
         c <= std::min(column + 1, m_width - 1); ++c) {
      least = std::min(least, m_outlineDepths[r * m_width + c].least);
      greatest = std::max(greatest, m_outlineDepths[r * m_width + c].greatest);
    }
  return greatest - least > jumpDepth;
}

/// True if the point is occluded, and both the outline and nearer, unoccluded focus are within the
/// width of a slot, and a pixel for its sampling.
bool FocusView::isInSlot(const Point& point, const Surface& surface) const {
  if (point.depth - surface(point.raster) <= strictTolerance)
    return false;
  const double raysPerMm = double{raysAcrossPixel} * m_view.size / (2.0 * m_view.halfHeight);
  const auto radius = static_cast<std::int64_t>(
      std::ceil(std::min(m_field.longestEdge(), 2.0) * raysPerMm) + raysAcrossPixel);
  const std::size_t center = findNearestRay(point.raster);
  const auto width = static_cast<std::int64_t>(m_width);
  const std::int64_t row = static_cast<std::int64_t>(center) / width,
                     column = static_cast<std::int64_t>(center) % width;
  bool hasOutside = false, hasNearer = false;
  for (std::int64_t r = std::max<std::int64_t>(row - radius, 0);
       r <= std::min(row + radius, width - 1); ++r)
    for (std::int64_t c = std::max<std::int64_t>(column - radius, 0);
         c <= std::min(column + radius, width - 1); ++c) {
      const auto ray = static_cast<std::size_t>(r * width + c);
      hasOutside = hasOutside || m_rays[ray] == infinity;
      hasNearer = hasNearer || (m_rays[ray] < point.depth - strictTolerance &&
                                m_rays[ray] - surface(rasterPosition(ray)) <= strictTolerance);
    }
  return hasOutside && hasNearer;
}

BoundaryMeasure FocusView::measure(const Surface& surface) const {
  BoundaryMeasure result;
  std::vector<double> gaps, cuts;
  for (const auto& [inner, outer] : m_outline)
    if (!isAtJump(inner) && !isAtOutlineJump(inner) && !isInSlot(inner, surface)) {
      gaps.push_back(std::abs(inner.depth - surface(outer)));
      cuts.push_back(std::max(0.0, surface(inner.raster) - inner.depth));
    }
  result.outlinePoints = static_cast<double>(m_outline.size());
  result.jumpFraction = 1.0 - static_cast<double>(gaps.size()) / result.outlinePoints;
  result.gap = summarize(std::move(gaps));
  result.cut = summarize(std::move(cuts));

  double jumps = 0.0, halfVoxelSmooth = 0.0;
  for (std::size_t ray = 0; ray < m_rays.size(); ++ray)
    if (m_rays[ray] < infinity) {
      const Vec2 raster = rasterPosition(ray);
      const double remaining = m_rays[ray] - surface(raster);
      if (isInSlot({raster, m_rays[ray]}, surface)) {
        result.slotFraction += 1.0;
        continue;
      }
      const bool isJump = isAtJump({raster, m_rays[ray]});
      const bool isShown = remaining <= 0.5 * m_field.longestEdge();
      result.rays += 1.0;
      result.strictFraction += remaining <= strictTolerance ? 1.0 : 0.0;
      result.halfVoxelFraction += isShown ? 1.0 : 0.0;
      jumps += isJump ? 1.0 : 0.0;
      halfVoxelSmooth += isShown && !isJump ? 1.0 : 0.0;
    }
  result.slotFraction /= result.rays;
  result.strictFraction /= result.rays;
  result.halfVoxelFraction /= result.rays;
  result.halfVoxelSmooth = halfVoxelSmooth / (result.rays - jumps);
  result.rayJumpFraction = jumps / result.rays;
  const auto width = static_cast<std::size_t>(m_view.size);
  for (std::size_t i = 0; i < m_centers.size(); ++i)
    if (m_centers[i] < infinity) {
      const Vec2 center(static_cast<double>(i % width) + 0.5, static_cast<double>(i / width) + 0.5);
      if (!isInSlot({center, m_centers[i]}, surface))
        result.centerGap = std::max(result.centerGap, m_centers[i] - surface(center));
    }
  return result;
}

ImageMatch FocusView::match(const std::vector<float>& depths, const Surface& surface) const {
  constexpr double tolerance = 0.1; // mm: a few mean free paths
  constexpr double step = 0.25;     // pixels between examined points
  const auto size = static_cast<std::size_t>(m_view.size);
  ImageMatch result;
  for (std::size_t row = 1; row + 1 < size; ++row)
    for (std::size_t column = 1; column + 1 < size; ++column) {
      const std::size_t pixel = row * size + column;
      const bool isBeside = m_centers[pixel - 1] < infinity || m_centers[pixel + 1] < infinity ||
                            m_centers[pixel - size] < infinity ||
                            m_centers[pixel + size] < infinity;
      if (!isBeside)
        continue;
      double least = infinity, greatest = -infinity;
      bool isContext = m_centers[pixel] == infinity;
      for (double y = 0.0; y <= 1.0 && isContext; y += step)
        for (double x = 0.0; x <= 1.0; x += step) {
          const Vec2 raster(static_cast<double>(column) + x, static_cast<double>(row) + y);
          isContext = isContext && focusDepth(raster) == infinity;
          least = std::min(least, surface(raster));
          greatest = std::max(greatest, surface(raster));
        }
      if (!isContext)
        continue;
      const double depth = double{depths[pixel]};
      result.pixels += 1.0;
      result.fraction += depth >= least - tolerance && depth <= greatest + tolerance ? 1.0 : 0.0;
    }
  result.fraction /= result.pixels;
  return result;
}

} // namespace fenestra::core::accuracy
