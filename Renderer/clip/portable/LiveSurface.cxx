#include "clip/portable/LiveSurface.h"

#include "clip/portable/SmoothFill.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace fenestra::core {
namespace {

using Vector = std::array<double, 3>;

double findDistance(const Vector& a, const Vector& b) {
  return std::hypot(b[0] - a[0], b[1] - a[1], b[2] - a[2]);
}
double dot(const Vector& a, const Vector& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
Vector cross(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
Vector normalize(const Vector& v) {
  const double length = std::sqrt(dot(v, v));
  if (!(length > 0.0) || !std::isfinite(length))
    throw std::invalid_argument("the camera has no direction");
  return {v[0] / length, v[1] / length, v[2] / length};
}

ViewFrame makeFrame(const LiveCamera& camera) {
  const Vector toTarget = {camera.target[0] - camera.position[0],
                           camera.target[1] - camera.position[1],
                           camera.target[2] - camera.position[2]};
  const Vector forward = normalize(toTarget);
  const Vector right = normalize(cross(forward, camera.up));
  ViewFrame frame{{}, dot(toTarget, forward), camera.isPerspective};
  const std::array<Vector, 3> rows = {right, cross(right, forward), forward};
  for (std::size_t axis = 0; axis < 3; ++axis)
    frame.toView[axis] = {rows[axis][0], rows[axis][1], rows[axis][2],
                          -dot(rows[axis], camera.position)};
  return frame;
}

/// Size of a pixel on the plane through the target, mm.
double findPitch(const LiveCamera& camera, const ViewFrame& frame) {
  constexpr double radiansPerDegree = 3.14159265358979323846 / 180.0;
  const double half = camera.isPerspective
                          ? frame.targetDepth * std::tan(0.5 * radiansPerDegree * camera.angle)
                          : camera.scale;
  const double pitch = 2.0 * half / camera.height;
  if (camera.width < 1 || camera.height < 1 || !(pitch > 0.0) || !std::isfinite(pitch))
    throw std::invalid_argument("the view has no size");
  return pitch;
}

/// Every `step`-th pixel of a rectangle, which may reach beyond the view.
struct PixelGrid {
  int left, top, columns, rows, step;

  std::size_t index(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
           static_cast<std::size_t>(column);
  }
  std::size_t size() const { return index(0, rows); }
  bool contains(int pixelColumn, int pixelRow) const {
    return pixelColumn >= left && pixelRow >= top && pixelColumn < left + step * columns &&
           pixelRow < top + step * rows;
  }
  /// Index of the sample nearest to a pixel right of `left` and below `top`.
  std::size_t indexNear(int pixelColumn, int pixelRow) const {
    return index(std::min((pixelColumn - left + step / 2) / step, columns - 1),
                 std::min((pixelRow - top + step / 2) / step, rows - 1));
  }
};

/// The pixels of a view, and those beyond it, on the plane through the target.
struct PixelPlane {
  int width, height;
  double pitch; ///< mm

  double x(int column) const { return (column + 0.5 - 0.5 * width) * pitch; }
  double y(int row) const { return (0.5 * height - row - 0.5) * pitch; }
  SampleGrid samples(const PixelGrid& grid) const {
    return {x(grid.left), y(grid.top), pitch * grid.step, grid.columns, grid.rows};
  }
  bool isInView(int column, int row) const {
    return column >= 0 && row >= 0 && column < width && row < height;
  }
  bool isInView(const ProjectedSurface::Bounds& bounds) const {
    const double x = 0.5 * width * pitch, y = 0.5 * height * pitch;
    return bounds.lowerX >= -x && bounds.upperX <= x && bounds.lowerY >= -y && bounds.upperY <= y;
  }
};

/// Number of a pixel, from 0 to `count`.
int clampToView(double pixel, int count) {
  return static_cast<int>(std::clamp(pixel, 0.0, static_cast<double>(count)));
}

/// The pixels of the view that the focus may cover, and those beside them.
PixelGrid findFocusPixels(const PixelPlane& plane, const ProjectedSurface::Bounds& bounds) {
  const double x = 0.5 * plane.width, y = 0.5 * plane.height;
  const int left = clampToView(std::floor(bounds.lowerX / plane.pitch + x) - 1.0, plane.width);
  const int right = clampToView(std::ceil(bounds.upperX / plane.pitch + x) + 1.0, plane.width);
  const int top = clampToView(std::floor(y - bounds.upperY / plane.pitch) - 1.0, plane.height);
  const int bottom = clampToView(std::ceil(y - bounds.lowerY / plane.pitch) + 1.0, plane.height);
  return {left, top, std::max(right - left, 0), std::max(bottom - top, 0), 1};
}

/// Every `step`-th pixel of the view and of the volume's projection, as in stills.
PixelGrid findFillPixels(const PixelPlane& plane, const ProjectedSurface::Bounds& volume) {
  constexpr int most = 128; // samples along the longer side of the view
  const int step = std::max(1, (std::max(plane.width, plane.height) + most - 1) / most);
  const auto before = [&](double mm, int size) { // samples before the view
    const double samples = std::ceil((mm / plane.pitch - 0.5 * size) / step);
    return static_cast<int>(std::clamp(samples, 0.0, 2.0 * most));
  };
  const auto count = [&](int size) { return (size + step - 1) / step; };
  const int left = before(-volume.lowerX, plane.width), right = before(volume.upperX, plane.width);
  const int top = before(volume.upperY, plane.height),
            bottom = before(-volume.lowerY, plane.height);
  return {-step * left, -step * top, count(plane.width) + left + right,
          count(plane.height) + top + bottom, step};
}

constexpr float noDepth = std::numeric_limits<float>::infinity();

/// Depths at pixels, mm; noDepth: not known.
struct PixelDepths {
  PixelGrid grid;
  std::vector<float> depths;

  explicit PixelDepths(const PixelGrid& pixels) : grid(pixels), depths(pixels.size(), noDepth) {}
  bool isKnown(std::size_t sample) const { return depths[sample] < noDepth; }
  bool isBesideKnown(int column, int row) const {
    for (int r = std::max(row - 1, 0); r <= std::min(row + 1, grid.rows - 1); ++r)
      for (int c = std::max(column - 1, 0); c <= std::min(column + 1, grid.columns - 1); ++c)
        if (isKnown(grid.index(c, r)))
          return true;
    return false;
  }
};

/// Samples beside the focus, with the depth of its outline: the halo of stills
/// (clip/field/SilhouetteCells.h). As there, this is where the sample's ray passes the focus most
/// closely, and of several contours the nearest to the camera hides the others.
class Halo {
public:
  using Edge = ProjectedSurface::ContourEdge;

  Halo(const PixelDepths& focus, const PixelPlane& plane, const std::vector<Edge>& contour)
      : m_focus(focus),
        m_samples(plane.samples(focus.grid)),
        m_halo(focus.grid),
        m_squaredDistances(focus.grid.size(), noDepth) {
    for (const Edge& edge : contour)
      add(edge);
  }

  const PixelDepths& depths() const { return m_halo; }

private:
  /// Largest distance of a ray from the contour, samples. Beside a corner of the focus, rays can be
  /// farther away; stills have no depth there either.
  static constexpr double reach = 1.25;

  static int clampSample(double position, int count) {
    return static_cast<int>(std::clamp(position, -1.0, static_cast<double>(count)));
  }

  void add(const Edge& edge) {
    const double x = (edge.ends[0].x - m_samples.x) / m_samples.pitch;
    const double y = (m_samples.y - edge.ends[0].y) / m_samples.pitch;
    const double dx = (edge.ends[1].x - edge.ends[0].x) / m_samples.pitch;
    const double dy = (edge.ends[0].y - edge.ends[1].y) / m_samples.pitch;
    const double perSquare = 1.0 / std::max(dx * dx + dy * dy, 1e-12);
    const int columns = m_samples.columns, rows = m_samples.rows;
    const int left = std::max(clampSample(std::min(x, x + dx) - reach, columns), 0);
    const int right = std::min(clampSample(std::max(x, x + dx) + reach, columns), columns - 1);
    const int top = std::max(clampSample(std::min(y, y + dy) - reach, rows), 0);
    const int bottom = std::min(clampSample(std::max(y, y + dy) + reach, rows), rows - 1);
    for (int row = top; row <= bottom; ++row)
      for (int column = left; column <= right; ++column) {
        if (m_focus.isKnown(m_focus.grid.index(column, row)))
          continue;
        const double t = std::clamp(((column - x) * dx + (row - y) * dy) * perSquare, 0.0, 1.0);
        const double across = x + t * dx - column, down = y + t * dy - row;
        add(column, row, across * across + down * down,
            edge.ends[0].depth + t * (edge.ends[1].depth - edge.ends[0].depth));
      }
  }

  void add(int column, int row, double squaredDistance, double depth) {
    constexpr double jump = 4.0; // mm, from one contour to another
    const std::size_t sample = m_focus.grid.index(column, row);
    float& nearest = m_halo.depths[sample];
    const bool isNearer = depth < nearest - jump ||
                          (depth < nearest + jump && squaredDistance < m_squaredDistances[sample]);
    if (squaredDistance > reach * reach || !isNearer || !m_focus.isBesideKnown(column, row))
      return;
    nearest = static_cast<float>(depth);
    m_squaredDistances[sample] = static_cast<float>(squaredDistance);
  }

  const PixelDepths& m_focus;
  SampleGrid m_samples;
  PixelDepths m_halo;
  std::vector<float> m_squaredDistances; ///< from the ray to the contour, samples
};

/// Depths of the focus and its halo.
PixelDepths join(const PixelDepths& focus, const PixelDepths& halo) {
  PixelDepths joined = focus;
  for (std::size_t i = 0; i < joined.depths.size(); ++i)
    joined.depths[i] = std::min(focus.depths[i], halo.depths[i]); // one of them is noDepth
  return joined;
}

/// Depths of the focus at the fill's samples, and of its halo at those beyond the view.
PixelDepths sampleFocus(const ProjectedSurface& surface, const PixelPlane& plane,
                        const PixelDepths& inView, const PixelGrid& grid) {
  PixelDepths found(grid);
  if (!plane.isInView(surface.bounds())) {
    found.depths = surface.findDepths(plane.samples(grid));
    found = join(found, Halo(found, plane, surface.findContour()).depths());
  }
  for (int row = 0; row < grid.rows; ++row)
    for (int column = 0; column < grid.columns; ++column) {
      const int x = grid.left + column * grid.step, y = grid.top + row * grid.step;
      if (plane.isInView(x, y))
        found.depths[grid.index(column, row)] =
            inView.grid.contains(x, y) ? inView.depths[inView.grid.indexNear(x, y)] : noDepth;
    }
  return found;
}

/// Sets the fill's samples to the mean of the halo around them; stills smooth it as well.
void addHalo(PixelDepths& fill, const PixelDepths& halo) {
  std::vector<float> counts(fill.depths.size(), 0.0F);
  for (int row = 0; row < halo.grid.rows; ++row)
    for (int column = 0; column < halo.grid.columns; ++column)
      if (const std::size_t from = halo.grid.index(column, row); halo.isKnown(from)) {
        const std::size_t to = fill.grid.indexNear(halo.grid.left + column * halo.grid.step,
                                                   halo.grid.top + row * halo.grid.step);
        float& mean = fill.depths[to];
        counts[to] += 1.0F;
        mean =
            counts[to] == 1.0F ? halo.depths[from] : mean + (halo.depths[from] - mean) / counts[to];
      }
}

/// Gives the samples of the focus at its outline the mean depth of those beside it, as in stills
/// (ClippingSurface.cxx): the depths interpolated beside the focus do not rise toward it.
void continueBelowFocus(const PixelDepths& focus, std::vector<float>& depths) {
  const PixelGrid& grid = focus.grid;
  const std::vector<float> before = depths;
  for (int row = 0; row < grid.rows; ++row)
    for (int column = 0; column < grid.columns; ++column) {
      if (!focus.isKnown(grid.index(column, row)))
        continue;
      float sum = 0.0F, count = 0.0F;
      for (int r = std::max(row - 1, 0); r <= std::min(row + 1, grid.rows - 1); ++r)
        for (int c = std::max(column - 1, 0); c <= std::min(column + 1, grid.columns - 1); ++c)
          if (const std::size_t beside = grid.index(c, r); !focus.isKnown(beside)) {
            sum += before[beside];
            count += 1.0F;
          }
      if (count > 0.0F)
        depths[grid.index(column, row)] = sum / count;
    }
}

/// Every `step`-th of the pixels.
PixelDepths thin(const PixelDepths& all, int step) {
  const PixelGrid& grid = all.grid;
  PixelDepths thinned(
      {grid.left, grid.top, (grid.columns + step - 1) / step, (grid.rows + step - 1) / step, step});
  for (int row = 0; row < thinned.grid.rows; ++row)
    for (int column = 0; column < thinned.grid.columns; ++column)
      thinned.depths[thinned.grid.index(column, row)] =
          all.depths[grid.index(column * step, row * step)];
  return thinned;
}

/// Pixels along an axis of a grid: the first one, and each `step`-th of `count` in all.
struct PixelRow {
  int first, count, step;
};

/// Pixels of both rows, but none of the first row's where the second one is.
std::vector<int> mergePixels(const PixelRow& coarse, const PixelRow& dense) {
  std::vector<int> pixels;
  for (int i = 0; i < dense.count; ++i)
    pixels.push_back(dense.first + i * dense.step);
  const int end = dense.first + dense.count * dense.step;
  for (int i = 0; i < coarse.count; ++i)
    if (const int pixel = coarse.first + i * coarse.step; pixel < dense.first || pixel >= end)
      pixels.push_back(pixel);
  std::sort(pixels.begin(), pixels.end());
  return pixels;
}

/// The fill's samples, but those of `dense` where it is. Depths relative to `reference`, since
/// floats of far cameras are coarse.
FillGrid makeGrid(const PixelPlane& plane, const PixelDepths& fill, const PixelDepths& dense,
                  double reference) {
  const PixelGrid &f = fill.grid, &d = dense.grid;
  const std::vector<int> columns =
      mergePixels({f.left, f.columns, f.step}, {d.left, d.columns, d.step});
  const std::vector<int> rows = mergePixels({f.top, f.rows, f.step}, {d.top, d.rows, d.step});
  FillGrid grid;
  for (const int column : columns)
    grid.x.push_back(plane.x(column));
  for (const int row : rows) {
    grid.y.push_back(plane.y(row));
    for (const int column : columns) {
      const PixelDepths& from = d.contains(column, row) ? dense : fill;
      const float depth = from.depths[from.grid.indexNear(column, row)];
      grid.depths.push_back(static_cast<float>(depth - reference));
      grid.isKnown.push_back(depth < noDepth ? 1 : 0);
    }
  }
  return grid;
}

/// Step, in pixels, from which on the far surface hardly depends: it bends over its length.
int findOutlineStep(double length, const PixelPlane& plane, const PixelGrid& fill) {
  return static_cast<int>(std::clamp(0.025 * length / plane.pitch, 1.0, double(fill.step)));
}

void runSerially(std::size_t count, std::size_t /*grain*/,
                 const std::function<void(std::size_t, std::size_t)>& work) {
  work(0, count);
}

ProjectedSurface::Bounds findBounds(const BoxCorners& volume, const ViewFrame& frame) {
  SurfaceTriangles corners;
  for (const auto& corner : volume)
    for (const double coordinate : corner)
      corners.points.push_back(static_cast<float>(coordinate));
  const ClosedSurface box(std::move(corners));
  return ProjectedSurface(box, frame).bounds();
}

} // namespace

LiveSurface buildLiveSurface(const ClosedSurface& focus, const BoxCorners& volume,
                             const LiveCamera& camera) {
  LiveSurface surface{makeFrame(camera), {}, {}};
  const PixelPlane plane{camera.width, camera.height, findPitch(camera, surface.view)};
  const ProjectedSurface projected(focus, surface.view);
  PixelDepths inView(findFocusPixels(plane, projected.bounds()));
  surface.focus.grid = plane.samples(inView.grid);
  surface.focus.depths = inView.depths = projected.findDepths(surface.focus.grid);

  PixelDepths fill = sampleFocus(projected, plane, inView,
                                 findFillPixels(plane, findBounds(volume, surface.view)));
  const double length = levelingLength(findDistance(volume[0], volume[7]));
  const PixelDepths outlined = thin(inView, findOutlineStep(length, plane, fill.grid));
  const PixelDepths halo = Halo(outlined, plane, projected.findContour()).depths();
  const double reference = surface.view.targetDepth;
  const FillGrid farGrid = makeGrid(plane, fill, join(outlined, halo), reference);
  if (std::find(farGrid.isKnown.begin(), farGrid.isKnown.end(), 1) == farGrid.isKnown.end())
    return surface;
  const FarSurface far(farGrid, length);
  PixelDepths start = fill;
  addHalo(start, halo);
  FillGrid grid = makeGrid(plane, start, PixelDepths({}), reference);
  fillSmoothly(grid, far, length, runSerially);
  continueBelowFocus(fill, grid.depths);
  surface.fill = {plane.samples(fill.grid), std::move(grid.depths)};
  for (float& depth : surface.fill.depths)
    depth = static_cast<float>(depth + reference);
  return surface;
}

} // namespace fenestra::core
