#include "Clipping.h"

#include "SaddleSpline.h"

#include <algorithm>

namespace fenestra::core::oracle {
namespace {

/// Position, in [low, high], of the maximum of a function with one maximum there (ternary search).
template <typename Function>
double findMaximum(const Function& f, double low, double high) {
  for (int i = 0; i < 60; ++i) {
    const double a = low + (high - low) / 3.0, b = high - (high - low) / 3.0;
    const bool rises = f(a) < f(b);
    (rises ? low : high) = rises ? a : b;
  }
  return 0.5 * (low + high);
}

/// Result of a search for the focus along a ray.
struct DepthHit {
  double t;      ///< first t with indicator >= 1/2, else that of the maximum; infinity: neither
  double height; ///< indicator at t

  /// Replaces the maximum by a later one if 1/2 - laterHeight < (1/2 - height) / 64.
  void update(double later, double laterHeight) {
    if (laterHeight > 0.25 && (height <= 0.25 || 0.5 - laterHeight < (0.5 - height) / 64.0))
      *this = {later, laterHeight};
  }
};

/// Searches a ray within the volume: samples the indicator 25 times per voxel and at each
/// maximum between samples, where a ray may graze the surface; then bisects. Steps outside the
/// focus's box, where the indicator is 0, are counted but not evaluated.
DepthHit searchRay(const FocusField& focus, const Medium& medium, const Ray& ray,
                   const Interval& range) {
  Interval part = medium.boxInterval(ray.origin, ray.direction);
  part = {std::max(part.begin, range.begin), std::min(part.end, range.end)};
  const auto level = [&](double t) {
    const Vec3 world = ray.at(t);
    const double value = focus.at(world);
    return value > 0.0 && medium.contains(world) ? value : 0.0;
  };
  const auto bisect = [&](double outside, double inside) {
    for (int i = 0; i < 60; ++i) {
      const double middle = 0.5 * (outside + inside);
      (level(middle) >= 0.5 ? inside : outside) = middle;
    }
    return DepthHit{inside, 0.5};
  };
  const double step = 0.04 * focus.shortestEdge();
  double before = 0.0, here = part.isEmpty() ? 0.0 : level(part.begin);
  if (here >= 0.5)
    return {part.begin, 0.5};
  DepthHit best{part.begin, 0.0};
  const Interval near = focus.boxInterval(ray);
  for (double t = part.begin; t < part.end && t < near.end + step; t += step) {
    if (t + step < near.begin)
      continue;
    const double next = std::min(t + step, part.end), there = level(next);
    if (there >= 0.5)
      return bisect(t, next);
    if (here > 0.2 && here >= before && here >= there) {
      const double top = findMaximum(level, std::max(t - step, part.begin), next);
      const double height = level(top);
      if (height >= 0.5)
        return bisect(std::max(t - step, part.begin), top);
      best.update(top, height);
    }
    before = here;
    here = there;
  }
  best.update(part.end, here);
  return best;
}

double findFirstHit(const FocusField& focus, const Medium& medium, const Ray& ray) {
  const DepthHit hit = searchRay(focus, medium, ray, {});
  return hit.height >= 0.5 ? hit.t : infinity;
}

/// Spline solved from the textbook equations.
using Spline = testing_clipping::SaddleSpline<long double>;

/// Intersection of a camera ray with the focus.
struct Intersection {
  Vec2 onPlane;
  Vec3 world;
  double depth;
};

/// Depth of a hole outside the focus's outline.
class Hole {
public:
  Hole(const HoleDescription& description, const View& view, const std::vector<Intersection>& hits)
      : m_description(description), m_view(view) {
    const bool isBall = description.shape == HoleDescription::Shape::sphere;
    for (const Intersection& hit : hits) {
      m_bottom = std::max(m_bottom, hit.depth);
      const Vec3 at = isBall ? hit.world : Vec3(hit.onPlane.x(), hit.onPlane.y(), 0.0);
      m_lower = m_lower.cwiseMin(at);
      m_upper = m_upper.cwiseMax(at);
    }
    m_center = 0.5 * (m_lower + m_upper);
    for (const Intersection& hit : hits) {
      const Vec3 at = isBall ? hit.world : Vec3(hit.onPlane.x(), hit.onPlane.y(), 0.0);
      m_radius = std::max(m_radius, (at - m_center).norm());
    }
    m_radius += description.margin;
  }

  double depth(double x, double y) const {
    if (m_description.shape == HoleDescription::Shape::sphere)
      return sphereDepth(m_view.makeRay(x, y));
    const Vec3 at(x, y, 0.0);
    const bool isInBox =
        std::abs(x - m_center.x()) <= m_center.x() - m_lower.x() + m_description.margin &&
        std::abs(y - m_center.y()) <= m_center.y() - m_lower.y() + m_description.margin;
    const bool isInside = m_description.shape == HoleDescription::Shape::box
                              ? isInBox
                              : (at - m_center).norm() <= m_radius;
    return isInside ? m_bottom : -infinity;
  }

private:
  /// Depth at the larger solution t of |origin + t direction - center| = radius.
  double sphereDepth(const Ray& ray) const {
    const Vec3 from = ray.origin - m_center;
    const double a = ray.direction.squaredNorm(), b = 2.0 * from.dot(ray.direction),
                 c = from.squaredNorm() - m_radius * m_radius;
    const double discriminant = b * b - 4.0 * a * c;
    if (discriminant < 0.0)
      return -infinity;
    return m_view.depth(ray.at((-b + std::sqrt(discriminant)) / (2.0 * a)));
  }

  const HoleDescription& m_description;
  const View& m_view;
  Vec3 m_lower = Vec3::Constant(infinity), m_upper = Vec3::Constant(-infinity), m_center;
  double m_radius = 0.0, m_bottom = -infinity;
};

/// `isFocus`: receives whether each sample's ray hits the focus.
std::vector<double> computeDepths(const DepthClip& clip, const FocusField& focus, const View& view,
                                  const Medium& medium, std::vector<bool>& isFocus) {
  std::vector<double> depths;
  std::vector<Intersection> hits;
  for (const double y : clip.rows)
    for (const double x : clip.columns) {
      const Ray ray = view.makeRay(x, y);
      const double t = findFirstHit(focus, medium, ray);
      depths.push_back(t < infinity ? view.depth(ray.at(t)) : infinity);
      isFocus.push_back(t < infinity);
      if (t < infinity)
        hits.push_back({Vec2(x, y), ray.at(t), depths.back()});
    }
  std::optional<Spline> spline;
  std::optional<Hole> hole;
  if (clip.hole)
    hole.emplace(*clip.hole, view, hits);
  else if (!clip.isCutaway && clip.givenDepths.empty())
    spline.emplace(clip.sites, clip.depths, clip.smoothing);
  std::size_t sample = 0;
  for (const double y : clip.rows)
    for (const double x : clip.columns) {
      double& depth = depths[sample];
      if (depth == infinity && !clip.givenDepths.empty())
        depth = clip.givenDepths[sample];
      else if (depth == infinity)
        depth = (spline ? (*spline)({x, y}) : hole ? hole->depth(x, y) : -infinity) + clip.offset;
      else
        depth += clip.offset;
      ++sample;
    }
  return depths;
}

/// Depths between which an exact surface is interpolated: focus samples beside others get the mean
/// depth of these, so that the surface beside the focus does not rise toward it.
std::vector<double> continueBesideFocus(const DepthClip& clip, const std::vector<double>& depths,
                                        const std::vector<bool>& isFocus) {
  std::vector<double> continued = depths;
  const auto columns = static_cast<int>(clip.columns.size());
  const auto rows = static_cast<int>(clip.rows.size());
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column) {
      double sum = 0.0, count = 0.0;
      for (int y = std::max(row - 1, 0); y < std::min(row + 2, rows); ++y)
        for (int x = std::max(column - 1, 0); x < std::min(column + 2, columns); ++x)
          if (const auto sample = static_cast<std::size_t>(y * columns + x); !isFocus[sample]) {
            sum += depths[sample];
            count += 1.0;
          }
      const auto own = static_cast<std::size_t>(row * columns + column);
      if (isFocus[own] && count > 0.0)
        continued[own] = sum / count;
    }
  return continued;
}

double edgeWeight(const Edge& edge, double behind) {
  if (behind < 0.0)
    return edge.ghost;
  if (edge.softness == 0.0)
    return 1.0;
  return edge.ghost + (1.0 - edge.ghost) * std::min(1.0, behind / edge.softness);
}

/// Position of a coordinate among monotone samples: index of the sample before it, and fraction of
/// the distance to the next one. Clamped at the ends.
struct SamplePosition {
  std::size_t before;
  double fraction;
};

SamplePosition locateSample(const std::vector<double>& samples, double coordinate) {
  const bool rises = samples.back() > samples.front();
  std::size_t next = 1;
  while (next + 1 < samples.size() &&
         (rises ? samples[next] < coordinate : samples[next] > coordinate))
    ++next;
  if (samples.size() == 1)
    return {0, 0.0};
  const double fraction = (coordinate - samples[next - 1]) / (samples[next] - samples[next - 1]);
  return {next - 1, std::clamp(fraction, 0.0, 1.0)};
}

} // namespace

FocusField::FocusField(const Mask& mask)
    : m_mask(mask),
      m_worldToIndex(mask.grid.indexToWorld.inverse()),
      m_lower(Vec3::Constant(infinity)),
      m_upper(Vec3::Constant(-infinity)) {
  const Size3& size = mask.grid.size;
  for (std::int64_t i = 0; i < size.prod(); ++i)
    if (mask.voxels[static_cast<std::size_t>(i)] != 0) {
      const Size3 voxel(i % size[0], i / size[0] % size[1], i / size[0] / size[1]);
      m_lower = m_lower.cwiseMin(voxel.cast<double>() - Vec3::Ones());
      m_upper = m_upper.cwiseMax(voxel.cast<double>() + Vec3::Ones());
    }
}

Interval FocusField::boxInterval(const Ray& ray) const {
  return intersectBox({m_lower, m_upper}, transformRay(m_worldToIndex, ray));
}

double FocusField::at(const Vec3& world) const {
  const Vec3 index = m_worldToIndex * world;
  for (int axis = 0; axis < 3; ++axis)
    if (!(index[axis] > m_lower[axis] && index[axis] < m_upper[axis]))
      return 0.0;
  const Size3& size = m_mask.grid.size;
  const Vec3 base = index.array().floor();
  const Vec3 upper = index - base, lower = 1.0 - upper.array();
  const Size3 first = base.cast<std::int64_t>();
  double sum = 0.0;
  for (std::int64_t z = first[2]; z < first[2] + 2; ++z)
    for (std::int64_t y = first[1]; y < first[1] + 2; ++y)
      for (std::int64_t x = first[0]; x < first[0] + 2; ++x) {
        if (x < 0 || x >= size[0] || y < 0 || y >= size[1] || z < 0 || z >= size[2])
          continue;
        const double weight = (x == first[0] ? lower : upper)[0] *
                              (y == first[1] ? lower : upper)[1] *
                              (z == first[2] ? lower : upper)[2];
        sum += weight * m_mask.voxels[static_cast<std::size_t>(x + size[0] * (y + size[1] * z))];
      }
  return sum;
}

Clipping::Clipping(const ClipDescription& description, const View& view, const Medium& medium)
    : m_description(description), m_view(view), m_medium(medium) {
  if (const auto* clip = std::get_if<DepthClip>(&description)) {
    m_focus.emplace(clip->focus);
    std::vector<bool> isFocus;
    m_depths = computeDepths(*clip, *m_focus, view, medium, isFocus);
    m_interpolated =
        clip->givenDepths.empty() ? m_depths : continueBesideFocus(*clip, m_depths, isFocus);
  }
}

double Clipping::sampleDepth(std::size_t column, std::size_t row) const {
  const auto& clip = std::get<DepthClip>(m_description);
  return m_interpolated[std::min(row, clip.rows.size() - 1) * clip.columns.size() +
                        std::min(column, clip.columns.size() - 1)];
}

double Clipping::linearSurface(const Vec2& at) const {
  const auto& clip = std::get<DepthClip>(m_description);
  const SamplePosition x = locateSample(clip.columns, at.x()), y = locateSample(clip.rows, at.y());
  return (1.0 - y.fraction) * ((1.0 - x.fraction) * sampleDepth(x.before, y.before) +
                               x.fraction * sampleDepth(x.before + 1, y.before)) +
         y.fraction * ((1.0 - x.fraction) * sampleDepth(x.before, y.before + 1) +
                       x.fraction * sampleDepth(x.before + 1, y.before + 1));
}

double Clipping::depthClipWeight(double depth, const Vec2& at) const {
  const auto& clip = std::get<DepthClip>(m_description);
  const SamplePosition x = locateSample(clip.columns, at.x()), y = locateSample(clip.rows, at.y());
  const auto weightBehind = [&](double surface) { return edgeWeight(clip.edge, depth - surface); };
  if (clip.hasSteps())
    return weightBehind(
        sampleDepth(x.before + (x.fraction >= 0.5), y.before + (y.fraction >= 0.5)));
  const double linearDepth = linearSurface(at);
  const auto cell = clip.silhouettes.find(y.before * clip.columns.size() + x.before);
  if (cell == clip.silhouettes.end())
    return weightBehind(linearDepth);
  // The surface lies between two depths. If both give the same weight, no search is needed.
  const double weight = weightBehind(std::max(linearDepth, cell->second.max));
  if (weight == weightBehind(std::min(linearDepth, cell->second.min)))
    return weight;
  return weightBehind(silhouetteSurface(cell->second, at, linearDepth));
}

double Clipping::silhouetteSurface(const DepthClip::SilhouetteCell& cell, const Vec2& at,
                                   double linearDepth) const {
  const auto& clip = std::get<DepthClip>(m_description);
  const Ray ray = m_view.makeRay(at.x(), at.y());
  const double depthPerLength = m_view.depth(ray.at(1.0)) - m_view.depth(ray.at(0.0));
  const auto lengthTo = [&](double depth) {
    return (depth - clip.offset - m_view.depth(ray.at(0.0))) / depthPerLength;
  };
  const DepthHit hit =
      searchRay(*m_focus, m_medium, ray, {std::max(0.0, lengthTo(cell.min)), infinity});
  const double fraction = std::clamp((hit.height - 0.45) / 0.05, 0.0, 1.0);
  if (fraction == 0.0)
    return linearDepth;
  const double depth = m_view.depth(ray.at(hit.t)) + clip.offset;
  return linearDepth + fraction * (std::min(depth, cell.max) - linearDepth);
}

double Clipping::clipWeight(const Vec3& world) const {
  if (std::holds_alternative<std::monostate>(m_description))
    return 1.0;
  if (m_view.isPerspective && m_view.depth(world) <= 0.0)
    return 0.0;
  if (const auto* plane = std::get_if<PlaneClip>(&m_description))
    return edgeWeight(plane->edge, (plane->point - world).dot(plane->normal));
  return depthClipWeight(m_view.depth(world), m_view.toPlane(world));
}

Vec3 Clipping::cutGradient(const Vec3& world) const {
  const auto* plane = std::get_if<PlaneClip>(&m_description);
  const auto* depth = std::get_if<DepthClip>(&m_description);
  if (!plane && !depth)
    return Vec3::Zero();
  const Edge& edge = plane ? plane->edge : depth->edge;
  const double weight = clipWeight(world);
  if (!(weight > edge.ghost && weight < 1.0)) // outside the softness
    return Vec3::Zero();
  Vec3 inward = m_view.forward;
  if (plane)
    inward = -plane->normal;
  else if (!depth->hasSteps())
    for (int axis = 0; axis < 3; ++axis) {
      const Vec3 step = 1e-5 * Vec3::Unit(axis);
      const auto behind = [&](const Vec3& at) {
        return m_view.depth(at) - linearSurface(m_view.toPlane(at));
      };
      inward[axis] = behind(world + step) - behind(world - step);
    }
  return 0.8 * inward.normalized();
}

} // namespace fenestra::core::oracle
