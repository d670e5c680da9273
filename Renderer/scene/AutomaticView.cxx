#include "scene/AutomaticView.h"

#include <Eigen/Cholesky>
#include <tbb/parallel_for.h>

namespace fenestra::core {
namespace {

constexpr double degree = pi / 180.0;
constexpr double goldenAngle = 2.399963229728653; ///< radians; steps of a Fibonacci lattice

/// Directions distributed evenly over the sphere.
std::vector<Vec3> spreadDirections(int count) {
  std::vector<Vec3> directions;
  for (int i = 0; i < count; ++i) {
    const double z = 1.0 - (2.0 * i + 1.0) / count;
    const double r = std::sqrt(1.0 - z * z);
    directions.emplace_back(r * std::cos(goldenAngle * i), r * std::sin(goldenAngle * i), z);
  }
  return directions;
}

/// Points distributed evenly over a disk.
std::vector<Vec2> spreadPoints(int count, double radius) {
  std::vector<Vec2> points;
  for (int i = 0; i < count; ++i) {
    const double r = radius * std::sqrt((i + 0.5) / count);
    points.emplace_back(r * std::cos(goldenAngle * i), r * std::sin(goldenAngle * i));
  }
  return points;
}

/// Normal of the frame, tilted toward its two other axes by `angles`, radians.
Vec3 tiltNormal(const Frame& frame, const Vec2& angles) {
  const double angle = angles.norm();
  const double sinc = angle > 0.0 ? std::sin(angle) / angle : 1.0;
  return frame.toWorld({sinc * angles.x(), sinc * angles.y(), std::cos(angle)});
}

std::vector<double> computeScores(const ViewScorer& scorer, const std::vector<Vec3>& directions,
                                  std::size_t rays) {
  std::vector<double> scores(directions.size());
  tbb::parallel_for(std::size_t{0}, directions.size(),
                    [&](std::size_t i) { scores[i] = scorer(directions[i], rays).score; });
  return scores;
}

/// Best of the directions on the sphere. Scores are weighted means over neighboring directions.
Vec3 searchCoarse(const ViewScorer& scorer) {
  constexpr double sigma = 15.0 * degree;
  constexpr std::size_t rays = 1024;
  const std::vector<Vec3> directions = spreadDirections(256);
  const std::vector<double> scores = computeScores(scorer, directions, rays);
  Vec3 best = Vec3::UnitY();
  double bestScore = 0.0;
  for (const Vec3& direction : directions) {
    double sum = 0.0, weights = 0.0;
    for (std::size_t i = 0; i < directions.size(); ++i) {
      const double weight = std::exp((direction.dot(directions[i]) - 1.0) / (sigma * sigma));
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

/// Step from the center of the points to the maximum of a quadratic that is fitted to their scores.
/// The fit has Gaussian weights of standard deviation `sigma`. The step is at most `sigma` long; if
/// there is no maximum, it follows the gradient. Normal equations suffice: with `sigma` as the unit
/// of length they are well-conditioned.
Vec2 stepToMaximum(const std::vector<Vec2>& points, const std::vector<double>& scores,
                   double sigma) {
  using Terms = Eigen::Matrix<double, 6, 1>;
  Eigen::Matrix<double, 6, 6> products = Eigen::Matrix<double, 6, 6>::Zero();
  Terms right = Terms::Zero();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec2 p = points[i] / sigma;
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
  const bool hasMaximum = determinant > 0.0 && xx + yy < 0.0;
  // Newton's step: minus the inverse of the second derivatives, times the slope.
  const Vec2 step = hasMaximum ? Vec2(-(yy * inverse) * slope.x() + xy * inverse * slope.y(),
                                      xy * inverse * slope.x() - xx * inverse * slope.y())
                               : slope;
  return sigma * (hasMaximum && step.norm() < 1.0 ? step : step.stableNormalized());
}

Vec3 searchNearby(const ViewScorer& scorer, const Vec3& start) {
  constexpr double searchRadius = 25.0 * degree, sigma = 12.0 * degree, tolerance = 0.5 * degree;
  constexpr double minHits = 1024.0;
  const double hitFraction = scorer(start, 1024).hitFraction;
  const auto rays =
      static_cast<std::size_t>(std::clamp(minHits / std::max(hitFraction, 1e-9), 1024.0, 32768.0));
  const std::vector<Vec2> points = spreadPoints(48, searchRadius);
  Vec3 best = start;
  for (int i = 0; i < 4; ++i) {
    const Frame frame(best);
    std::vector<Vec3> directions;
    for (const Vec2& point : points)
      directions.push_back(tiltNormal(frame, point));
    const Vec2 step = stepToMaximum(points, computeScores(scorer, directions, rays), sigma);
    best = tiltNormal(frame, step);
    if (step.norm() < tolerance)
      break;
  }
  return best;
}

} // namespace

ViewDirection findBestView(const ViewScorer& scorer) {
  const Vec3 best = searchNearby(scorer, searchCoarse(scorer));
  const bool isNearSuperior = std::abs(best.z()) > std::cos(15.0 * degree);
  return {best, isNearSuperior ? Vec3::UnitY() : Vec3::UnitZ()};
}

} // namespace fenestra::core
