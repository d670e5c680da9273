#include "clip/surface/ClippingSurface.h"

#include "base/Error.h"
#include "base/Stopwatch.h"
#include "clip/portable/SmoothFill.h"
#include "clip/surface/BufferFill.h"
#include "clip/surface/ThinPlateSpline.h"

#include <tbb/parallel_for.h>

#include <algorithm>

namespace fenestra::core {

namespace {

void checkOptions(const SurfaceOptions& options) {
  if (options.controlPoints < 1 || options.controlPoints > 1000)
    throw requestError(ErrorCode::invalidValue, "control points", "must be from 1 to 1000");
  if (!(options.smoothing >= 0.0 && options.smoothing <= 1.0))
    throw requestError(ErrorCode::invalidValue, "spline smoothing", "must be from 0 to 1");
}

std::string describeFocus(const Mask& focus) {
  std::string names = "focus";
  for (const std::string& name : focus.names)
    names += (names == "focus" ? " " : ", ") + name;
  return names;
}

bool isInViewport(const FocusDepth& focus) {
  const DepthAxis& x = focus.depth.xAxis();
  const DepthAxis& y = focus.depth.yAxis();
  for (std::int64_t row = y.before; row < y.before + y.inside; ++row)
    for (std::int64_t column = x.before; column < x.before + x.inside; ++column)
      if (focus.isFocus(column, row))
        return true;
  return false;
}

ThinPlateSpline fitSpline(const std::vector<ControlPoint>& points, double smoothing) {
  std::vector<Vec2> sites;
  std::vector<double> depths;
  for (const ControlPoint& point : points) {
    sites.push_back(point.site);
    depths.push_back(point.depth);
  }
  return {sites, depths, smoothing};
}

Distribution measureMismatch(const ThinPlateSpline& spline,
                             const std::vector<ControlPoint>& samples) {
  std::vector<double> errors;
  errors.reserve(samples.size());
  for (const ControlPoint& sample : samples)
    errors.push_back(std::abs(spline(sample.site) - sample.depth));
  return Distribution::compute(std::move(errors));
}

/// Fills the samples outside the focus from the spline, in tiles. Tiles near many sites are split,
/// to reduce the number of terms that need direct evaluation.
class SplineFill {
public:
  SplineFill(DepthBuffer& buffer, const std::vector<Region>& regions, const ThinPlateSpline& spline)
      : m_buffer(buffer),
        m_regions(regions),
        m_spline(spline),
        m_x(buffer.xAxis().coordinates()),
        m_y(buffer.yAxis().coordinates()) {}

  void fill() const {
    const std::int64_t tilesPerRow = (m_buffer.columns() + maxTileSize - 1) / maxTileSize;
    const std::int64_t down = (m_buffer.rows() + maxTileSize - 1) / maxTileSize;
    tbb::parallel_for(std::int64_t{0}, tilesPerRow * down, [&](std::int64_t tile) {
      const std::int64_t column = tile % tilesPerRow * maxTileSize,
                         row = tile / tilesPerRow * maxTileSize;
      fill({column, row, std::min(maxTileSize, m_buffer.columns() - column),
            std::min(maxTileSize, m_buffer.rows() - row)});
    });
  }

private:
  /// Rectangle of samples: first column and row, and counts.
  struct Tile {
    std::int64_t column, row, columns, rows;
  };

  static constexpr std::int64_t maxTileSize = ThinPlateSpline::maxColumns;
  static constexpr std::int64_t minTileSize = 8;
  /// Evaluating this many kernels directly costs about as much as the expansions of four tiles.
  static constexpr std::int64_t maxKernels = 2048;
  /// mm; below float rounding 10 mm from the target. On phantoms and scans, all depths were within
  /// one unit in the last place (float) of those of evaluateRow.
  static constexpr double tolerance = 1e-6;

  void fill(const Tile& tile) const {
    if (isFocus(tile))
      return;
    const std::span x = std::span(m_x).subspan(index(tile.column), index(tile.columns));
    const std::span y = std::span(m_y).subspan(index(tile.row), index(tile.rows));
    const bool canSplit = tile.columns > minTileSize || tile.rows > minTileSize;
    if (canSplit && m_spline.countNearTerms(x, y) * tile.columns * tile.rows > maxKernels)
      return fillSplit(tile);
    std::array<double, maxTileSize * maxTileSize> depths;
    m_spline.evaluateTile(x, y, tolerance, depths);
    for (std::int64_t row = 0; row < tile.rows; ++row)
      for (std::int64_t column = 0; column < tile.columns; ++column) {
        const std::int64_t sample = m_buffer.sample(tile.column + column, tile.row + row);
        if (m_regions[index(sample)] != Region::focus)
          m_buffer.set(sample, depths[index(row * tile.columns + column)]);
      }
  }

  void fillSplit(const Tile& tile) const {
    Tile first = tile, second = tile;
    if (tile.columns > tile.rows) {
      first.columns = tile.columns / 2;
      second.columns -= first.columns;
      second.column += first.columns;
    } else {
      first.rows = tile.rows / 2;
      second.rows -= first.rows;
      second.row += first.rows;
    }
    fill(first);
    fill(second);
  }

  bool isFocus(const Tile& tile) const {
    for (std::int64_t row = tile.row; row < tile.row + tile.rows; ++row) {
      const auto first = m_regions.begin() + m_buffer.sample(tile.column, row);
      if (std::any_of(first, first + tile.columns, [](Region r) { return r != Region::focus; }))
        return false;
    }
    return true;
  }

  static std::size_t index(std::int64_t i) { return static_cast<std::size_t>(i); }

  DepthBuffer& m_buffer;
  const std::vector<Region>& m_regions;
  const ThinPlateSpline& m_spline;
  std::vector<double> m_x, m_y; ///< mm, of the columns and rows
};

/// Sets -infinity outside the focus, where nothing is removed.
void fillCutaway(DepthBuffer& buffer, const std::vector<Region>& regions) {
  for (std::int64_t sample = 0; sample < buffer.size(); ++sample)
    if (regions[static_cast<std::size_t>(sample)] != Region::focus)
      buffer.set(sample, -infinity);
}

/// Gives the focus samples at the outline the mean depth of the samples beside them that are not
/// focus. Where rays hit the focus, silhouette cells have its exact depth; where they miss, the
/// interpolated depth is then that of the surface beside the focus.
void continueBelowFocus(DepthBuffer& buffer, const FocusDepth& focus) {
  std::vector<std::pair<std::int64_t, double>> depths;
  for (std::int64_t row = 0; row < buffer.rows(); ++row)
    for (std::int64_t column = 0; column < buffer.columns(); ++column) {
      if (!focus.isFocus(column, row))
        continue;
      double sum = 0.0, count = 0.0;
      for (std::int64_t r = std::max<std::int64_t>(row - 1, 0);
           r <= std::min(row + 1, buffer.rows() - 1); ++r)
        for (std::int64_t c = std::max<std::int64_t>(column - 1, 0);
             c <= std::min(column + 1, buffer.columns() - 1); ++c)
          if (!focus.isFocus(c, r)) {
            sum += buffer.at(buffer.sample(c, r));
            count += 1.0;
          }
      if (count > 0.0)
        depths.emplace_back(buffer.sample(column, row), sum / count);
    }
  for (const auto& [sample, depth] : depths)
    buffer.set(sample, depth);
}

/// Fills the surface with an exact boundary, starting at the halo.
void fillFromHalo(DepthBuffer& buffer, const FocusDepth& focus, const SilhouetteCells& silhouette,
                  double length) {
  fillSmoothly(buffer, focus.regions, silhouette.halo(), length);
  continueBelowFocus(buffer, focus);
}

/// Fits the spline to the focus's outline; sets control points, mismatch and warnings of `surface`.
ThinPlateSpline fitOutline(ClippingSurface& surface, const SurfaceOptions& options) {
  const std::vector<Contour> contours = traceContours(surface.focus);
  surface.controlPoints = placeControlPoints(surface.focus, contours, options.controlPoints);
  ThinPlateSpline spline = fitSpline(surface.controlPoints, options.smoothing);
  surface.mismatch = measureMismatch(spline, findBoundarySamples(surface.focus, contours));
  const auto requested = static_cast<std::size_t>(options.controlPoints);
  if (surface.controlPoints.size() < std::min<std::size_t>(3, requested))
    surface.warnings.push_back(makeMessage(
        ErrorCode::tinyFocus, "focus", "covers hardly a pixel, so the clipping surface is flat"));
  return spline;
}

} // namespace

void requireVisible(const FocusDepth& focus, const Mask& mask) {
  if (std::ranges::find(focus.regions, Region::focus) == focus.regions.end())
    throw inputError(
        ErrorCode::hiddenFocus, describeFocus(mask),
        "is not visible: it is outside the volume or its crop box, behind the camera, or smaller "
        "than a pixel");
}

ClippingSurface buildClippingSurface(const Camera& camera, const Domain& volume, const Mask& focus,
                                     const SurfaceOptions& options) {
  checkOptions(options);
  Stopwatch stopwatch;
  const auto tracer = std::make_shared<const FocusTracer>(camera, volume, focus);
  const FocusDepth focusDepth = tracer->traceDepths();
  ClippingSurface surface{.clip = {}, .focus = focusDepth, .shown = focusDepth};
  requireVisible(surface.focus, focus);
  if (!isInViewport(surface.focus))
    surface.warnings.push_back(
        makeMessage(ErrorCode::focusOutsideImage, describeFocus(focus), "is outside the image"));
  surface.focusSeconds = stopwatch.lap();

  auto buffer = std::make_shared<DepthBuffer>(surface.focus.depth);
  std::shared_ptr<SilhouetteCells> silhouette;
  if (options.mode == SurfaceMode::cutaway) {
    fillCutaway(*buffer, surface.focus.regions);
  } else if (options.mode == SurfaceMode::hole) {
    fillHole(*buffer, surface.focus, camera, options.hole);
  } else if (options.boundary == Boundary::exact) {
    silhouette = std::make_shared<SilhouetteCells>(tracer, surface.shown);
    *buffer = surface.shown.depth;
    const Vec3 diagonal = volume.grid().worldCorner(7) - volume.grid().worldCorner(0);
    fillFromHalo(*buffer, surface.shown, *silhouette, levelingLength(diagonal.norm()));
  } else {
    const ThinPlateSpline spline = fitOutline(surface, options);
    surface.splineSeconds = stopwatch.lap();
    SplineFill(*buffer, surface.focus.regions, spline).fill();
  }
  if (options.offset != 0.0) {
    buffer->move(options.offset);
    if (silhouette)
      silhouette->move(options.offset);
  }
  auto pyramid = std::make_shared<const DepthPyramid>(*buffer, silhouette.get());
  const auto lookup =
      options.mode == SurfaceMode::surface ? ClipDepth::Lookup::linear : ClipDepth::Lookup::nearest;
  surface.clip = ClipDepth{camera, std::move(buffer), std::move(pyramid),
                           lookup, options.edge,      std::move(silhouette)};
  surface.fillSeconds = stopwatch.lap();
  return surface;
}

} // namespace fenestra::core
