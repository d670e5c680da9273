#include "session/AutomaticView.h"

#include <Eigen/Cholesky>
#include <tbb/parallel_for.h>

namespace fenestra {
namespace {

constexpr double degree = pi / 180.0;
constexpr double goldenAngle = 2.399963229728653;

/// Directions spread evenly over the sphere.
std::vector<Vec3> allDirections(int count) {
  std::vector<Vec3> directions;
  for (int i = 0; i < count; ++i) {
    const double z = 1.0 - (2.0 * i + 1.0) / count;
    const double r = std::sqrt(1.0 - z * z);
    directions.emplace_back(r * std::cos(goldenAngle * i), r * std::sin(goldenAngle * i), z);
  }
  return directions;
}

/// Points spread evenly over a disc.
std::vector<Vec2> discPoints(int count, double radius) {
  std::vector<Vec2> points;
  for (int i = 0; i < count; ++i) {
    const double r = radius * std::sqrt((i + 0.5) / count);
    points.emplace_back(r * std::cos(goldenAngle * i), r * std::sin(goldenAngle * i));
  }
  return points;
}

/// Frame's normal, tilted toward its two other axes by `angles`, radians.
Vec3 turned(const Frame& frame, const Vec2& angles) {
  const double angle = angles.norm();
  const double perAngle = angle > 0.0 ? std::sin(angle) / angle : 1.0;
  return frame.toWorld({perAngle * angles.x(), perAngle * angles.y(), std::cos(angle)});
}

std::vector<double> scoresOf(const ViewScorer& score, const std::vector<Vec3>& directions,
                             std::size_t rays) {
  std::vector<double> scores(directions.size());
  tbb::parallel_for(std::size_t{0}, directions.size(),
                    [&](std::size_t i) { scores[i] = score(directions[i], rays).score; });
  return scores;
}

/// Best of directions all around, each scored by a weighted mean over its neighbours.
Vec3 coarseBest(const ViewScorer& score) {
  constexpr double near = 15.0 * degree;
  constexpr std::size_t rays = 1024;
  const std::vector<Vec3> directions = allDirections(256);
  const std::vector<double> scores = scoresOf(score, directions, rays);
  Vec3 best = Vec3::UnitY();
  double bestScore = 0.0;
  for (const Vec3& direction : directions) {
    double sum = 0.0, weights = 0.0;
    for (std::size_t i = 0; i < directions.size(); ++i) {
      const double weight = std::exp((direction.dot(directions[i]) - 1.0) / (near * near));
      sum += weight * scores[i];
      weights += weight;
    }
    if (sum > bestScore * weights) {
      bestScore = sum / weights;
      best = direction;
    }
  }
  return best;
}

/// Step from the middle of the points to the top of the quadratic fitted to their scores, with
/// Gaussian weights of deviation `near`; at most `near` long, uphill if there is no top. By normal
/// equations, which are far from singular with `near` as the unit of length.
Vec2 stepToTop(const std::vector<Vec2>& points, const std::vector<double>& scores, double near) {
  using Terms = Eigen::Matrix<double, 6, 1>;
  Eigen::Matrix<double, 6, 6> products = Eigen::Matrix<double, 6, 6>::Zero();
  Terms right = Terms::Zero();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec2 p = points[i] / near;
    const double weight = std::exp(-0.5 * p.squaredNorm());
    Terms terms;
    terms << 1.0, p.x(), p.y(), p.x() * p.x(), p.x() * p.y(), p.y() * p.y();
    products += weight * terms * terms.transpose();
    right += weight * scores[i] * terms;
  }
  const Terms fit = products.llt().solve(right);
  const Vec2 slope(fit[1], fit[2]);
  const double xx = 2.0 * fit[3], xy = fit[4], yy = 2.0 * fit[5]; // second derivatives
  const double determinant = xx * yy - xy * xy, inverse = 1.0 / determinant;
  const bool hasTop = determinant > 0.0 && xx + yy < 0.0;
  const Vec2 step = hasTop ? Vec2(-(yy * inverse) * slope.x() + xy * inverse * slope.y(),
                                  xy * inverse * slope.x() - xx * inverse * slope.y())
                           : slope;
  return near * (hasTop && step.norm() < 1.0 ? step : step.stableNormalized());
}

Vec3 refined(const ViewScorer& score, const Vec3& start) {
  constexpr double searchRadius = 25.0 * degree, near = 12.0 * degree, enough = 0.5 * degree;
  constexpr double enoughMeetings = 1024.0;
  const double met = score(start, 1024).met;
  const auto rays =
      static_cast<std::size_t>(std::clamp(enoughMeetings / std::max(met, 1e-9), 1024.0, 32768.0));
  const std::vector<Vec2> points = discPoints(48, searchRadius);
  Vec3 best = start;
  for (int i = 0; i < 4; ++i) {
    const Frame frame(best);
    std::vector<Vec3> directions;
    for (const Vec2& point : points)
      directions.push_back(turned(frame, point));
    const Vec2 step = stepToTop(points, scoresOf(score, directions, rays), near);
    best = turned(frame, step);
    if (step.norm() < enough)
      break;
  }
  return best;
}

} // namespace

ViewDirection automaticView(const ViewScorer& score) {
  const Vec3 best = refined(score, coarseBest(score));
  const bool alongBody = std::abs(best.z()) > std::cos(15.0 * degree);
  return {best, alongBody ? Vec3::UnitY() : Vec3::UnitZ()};
}

} // namespace fenestra
