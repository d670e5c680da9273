#include "LiveMeasure.h"

#include "clip/mesh/FocusTriangles.h"
#include "scene/PreparedScene.h"

#include <algorithm>
#include <cmath>
#include <ctime>

namespace fenestra::core::accuracy {
namespace {

/// Depth of the live surface at a pixel's center, and whether it is the focus's.
struct LiveDepth {
  double depth = infinity;
  bool isFocus = false;
};

/// Bilinear interpolation at a position on the plane through the target, as a texture unit's.
double interpolate(const DepthMap& map, double x, double y) {
  const auto clampIndex = [](double index, int count) {
    return std::clamp(index, 0.0, static_cast<double>(count - 1));
  };
  const double column = clampIndex((x - map.grid.x) / map.grid.pitch, map.grid.columns);
  const double row = clampIndex((map.grid.y - y) / map.grid.pitch, map.grid.rows);
  const int c = std::min(static_cast<int>(column), map.grid.columns - 2);
  const int r = std::min(static_cast<int>(row), map.grid.rows - 2);
  const auto at = [&](int i, int j) {
    return double{map.depths[static_cast<std::size_t>(j * map.grid.columns + i)]};
  };
  const double fx = column - c, fy = row - r;
  return (1.0 - fy) * ((1.0 - fx) * at(c, r) + fx * at(c + 1, r)) +
         fy * ((1.0 - fx) * at(c, r + 1) + fx * at(c + 1, r + 1));
}

LiveDepth findDepth(const LiveSurface& surface, const View& view, int column, int row) {
  const double pitch = 2.0 * view.halfHeight / view.size;
  const double x = (column + 0.5 - 0.5 * view.size) * pitch;
  const double y = (0.5 * view.size - row - 0.5) * pitch;
  const SampleGrid& grid = surface.focus.grid;
  const auto c = std::lround((x - grid.x) / pitch), r = std::lround((grid.y - y) / pitch);
  if (c >= 0 && r >= 0 && c < grid.columns && r < grid.rows) {
    const float depth = surface.focus.depths[static_cast<std::size_t>(r * grid.columns + c)];
    if (std::isfinite(depth))
      return {double{depth}, true};
  }
  return {interpolate(surface.fill, x, y), false};
}

LiveError summarize(std::vector<double> errors) {
  LiveError result;
  result.count = errors.size();
  if (errors.empty())
    return result;
  for (const double error : errors)
    result.mean += error / static_cast<double>(errors.size());
  const auto p95 = errors.begin() + static_cast<std::ptrdiff_t>(0.95 * double(errors.size()));
  std::nth_element(errors.begin(), p95, errors.end());
  result.p95 = *p95;
  return result;
}

SurfaceTriangles toTriangles(const SurfaceMesh& mesh) {
  SurfaceTriangles triangles;
  for (const Vec3& point : mesh.points)
    for (const double coordinate : point)
      triangles.points.push_back(static_cast<float>(coordinate));
  for (const auto& corners : mesh.triangles)
    triangles.corners.insert(triangles.corners.end(), corners.begin(), corners.end());
  return triangles;
}

std::array<double, 3> toArray(const Vec3& v) {
  return {v.x(), v.y(), v.z()};
}

double threadSeconds() {
  timespec time = {};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

} // namespace

LiveSubject::LiveSubject(const Subject& subject) {
  View any;
  any.position = Vec3(0, 500, 0);
  any.target = Vec3::Zero();
  any.up = Vec3::UnitZ();
  any.size = 1;
  RenderRequest request = makeRequest(subject, any, Boundary::exact);
  request.clip.mode = ClipMode::none;
  m_scene = std::make_unique<const PreparedScene>(request);
  m_subject = subject;
  const Grid& grid = m_scene->volume().grid;
  m_focus =
      std::make_unique<const ClosedSurface>(toTriangles(triangulate(*m_scene->focus(), grid)));
  Vec3 lower = Vec3::Constant(infinity), upper = -lower;
  for (std::size_t i = 0; i < m_focus->points().size(); i += 3) {
    const float* const at = &m_focus->points()[i];
    const Vec3 point(double{at[0]}, double{at[1]}, double{at[2]});
    lower = lower.cwiseMin(point);
    upper = upper.cwiseMax(point);
  }
  m_center = 0.5 * (lower + upper);
  m_radius = 0.5 * (upper - lower).norm();
  for (std::size_t i = 0; i < 8; ++i)
    m_volume[i] = toArray(grid.worldCorner(static_cast<int>(i)));
}

LiveSubject::~LiveSubject() = default;

View LiveSubject::makeView(double number, int count, int size, bool isPerspective) const {
  const double angle = 2.0 * pi * number / count, height = pi / 9.0;
  View view;
  view.target = m_center;
  view.position = m_center + 4.0 * m_radius *
                                 Vec3(std::cos(height) * std::sin(angle),
                                      std::cos(height) * std::cos(angle), std::sin(height));
  view.up = Vec3::UnitZ();
  view.isPerspective = isPerspective;
  view.halfHeight = 1.2 * m_radius;
  view.size = size;
  return view;
}

LiveSurface LiveSubject::build(const View& view) const {
  return buildLiveSurface(*m_focus, m_volume,
                          {toArray(view.position), toArray(view.target), toArray(view.up),
                           view.isPerspective, view.angle(), view.halfHeight, view.size,
                           view.size});
}

LiveDifference LiveSubject::compare(const View& view) const {
  const PreparedScene still = m_scene->withRequest(makeRequest(m_subject, view, Boundary::exact));
  const auto& clip = std::get<ClipDepth>(still.clip());
  const std::vector<double>& focusDepth = still.clipResult().focusDepth;
  const LiveSurface live = build(view);
  std::vector<double> focus, context;
  for (int row = 0; row < view.size; ++row)
    for (int column = 0; column < view.size; ++column) {
      const bool isFocus =
          focusDepth[static_cast<std::size_t>(row * view.size + column)] < infinity;
      const LiveDepth depth = findDepth(live, view, column, row);
      if (depth.isFocus != isFocus)
        continue;
      const double expected = clip.surfaceDepth(still.camera().toPlane(column + 0.5, row + 0.5));
      (isFocus ? focus : context).push_back(std::abs(depth.depth - expected));
    }
  return {summarize(std::move(focus)), summarize(std::move(context))};
}

double LiveSubject::measureTurn(int number) const {
  constexpr int steps = 10, size = 256;
  double sum = 0.0, count = 0.0;
  std::vector<LiveDepth> before;
  for (int step = 0; step <= steps; ++step) {
    const View view = makeView(number + step * 0.1 / 90.0, 4, size, false);
    const LiveSurface live = build(view);
    std::vector<LiveDepth> now;
    for (int row = 0; row < size; ++row)
      for (int column = 0; column < size; ++column)
        now.push_back(findDepth(live, view, column, row));
    for (std::size_t i = 0; i < before.size(); ++i)
      if (!before[i].isFocus && !now[i].isFocus) {
        sum += std::abs(now[i].depth - before[i].depth);
        count += 1.0;
      }
    before = std::move(now);
  }
  return sum / count;
}

double LiveSubject::measureSeconds() const {
  std::vector<double> seconds;
  for (int number = 0; number < 100; ++number) {
    const View view = makeView(number, 100, 512, number % 2 == 1);
    const double begin = threadSeconds();
    build(view);
    seconds.push_back(threadSeconds() - begin);
  }
  std::nth_element(seconds.begin(), seconds.begin() + 50, seconds.end());
  return seconds[50];
}

} // namespace fenestra::core::accuracy
