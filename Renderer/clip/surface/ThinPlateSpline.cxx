#include "clip/surface/ThinPlateSpline.h"

#include <Eigen/Cholesky>

#include <algorithm>
#include <iterator>

namespace fenestra::core {

namespace {

/// Keeps the logarithm finite at a site, where its factor is 0.
constexpr double tiny = 1e-300;

/// Smallest lambda - phi of two distinct sites, which is the smallest eigenvalue due to the pair.
/// Below this bound the solution loses too many digits.
constexpr double minEigenvalue = 1e-12;

/// Squared distance, in disk radii, beyond which cancellation spoils the sum of the kernels.
constexpr double farRadiusSquared = 256.0;

/// Rounding error of a site's coordinates, mm.
double coordinateRounding(const Vec2& site) {
  return 8.0 * std::numeric_limits<double>::epsilon() * site.cwiseAbs().maxCoeff();
}

/// phi of squared distances.
template <typename Derived>
auto phi(const Eigen::ArrayBase<Derived>& squared) {
  return squared * (squared + tiny).log();
}

template <typename Array>
auto toSpan(Array& array) {
  return std::span(array.data(), static_cast<std::size_t>(array.size()));
}

/// K + lambda I.
Eigen::MatrixXd makeKernelMatrix(const Eigen::MatrixX2d& sites, double lambda) {
  Eigen::MatrixXd k(sites.rows(), sites.rows());
  for (Eigen::Index i = 0; i < sites.rows(); ++i)
    k.col(i) = phi((sites.rowwise() - sites.row(i)).rowwise().squaredNorm().array());
  k.diagonal().array() += lambda;
  return k;
}

/// P = Q R by Householder reflections (Golub and Van Loan, "Matrix Computations", 5.1 and 5.2):
/// Q = H0 H1 H2 with Hk = I - vk vk'. The columns of Q after the third span the null space of P'.
class PolynomialQr {
public:
  /// `singular`: singular values below this fraction of the largest count as 0. Since the sites'
  /// centroid is 0, the largest is that of the constant, up to rounding.
  PolynomialQr(const Eigen::MatrixX2d& sites, double singular) : m_v(sites.rows(), 3) {
    m_v << Eigen::VectorXd::Ones(sites.rows()), sites;
    for (Eigen::Index k = 0; k < 3; ++k)
      reflect(k);
    const double squares = m_r.bottomRightCorner<2, 2>().squaredNorm();
    const double product = std::abs(m_r(1, 1) * m_r(2, 2)); // of both singular values
    m_maxSingular = std::sqrt(
        0.5 * (squares + std::sqrt(std::max(squares * squares - 4.0 * product * product, 0.0))));
    const double least = singular * std::abs(m_r(0, 0));
    m_rank = m_maxSingular <= least ? 1 : product <= least * m_maxSingular ? 2 : 3;
    m_minSingular = m_rank == 1 ? 0.0 : product / m_maxSingular;
  }

  int rank() const { return m_rank; }

  /// Q' x.
  Eigen::VectorXd applyQTransposed(Eigen::VectorXd x) const {
    for (Eigen::Index k = 0; k < 3; ++k)
      x -= m_v.col(k).dot(x) * m_v.col(k);
    return x;
  }

  /// Q x.
  Eigen::VectorXd applyQ(Eigen::VectorXd x) const {
    for (Eigen::Index k = 2; k >= 0; --k)
      x -= m_v.col(k).dot(x) * m_v.col(k);
    return x;
  }

  /// Q2' K Q2 of a symmetric K, where Q2 is Q without its first three columns.
  Eigen::MatrixXd projectToNullSpace(Eigen::MatrixXd k) const {
    for (Eigen::Index i = 0; i < 3; ++i) { // H K H = K - v w' - w v'
      const auto v = m_v.col(i);
      Eigen::VectorXd w = k * v;
      w -= 0.5 * v.dot(w) * v;
      for (Eigen::Index column = 0; column < k.cols(); ++column)
        k.col(column) -= w[column] * v + v[column] * w;
    }
    const Eigen::Index n = k.rows() - 3;
    return k.bottomRightCorner(n, n);
  }

  /// Least-squares solution a of P a = z with the smallest slope.
  Vec3 solveLeastSquares(const Eigen::VectorXd& z) const {
    const Eigen::VectorXd all = applyQTransposed(z);
    const Eigen::Index given = std::min<Eigen::Index>(3, all.size());
    Eigen::Vector3d right = Eigen::Vector3d::Zero();
    right.head(given) = all.head(given);
    Eigen::Vector3d a = Eigen::Vector3d::Zero();
    if (m_rank == 3) {
      a[2] = right[2] / m_r(2, 2);
      a[1] = (right[1] - m_r(1, 2) * a[2]) / m_r(1, 1);
    } else if (m_rank == 2) { // collinear: B'B - minSingular^2 I is a multiple of d d'
      const Eigen::Matrix2d b = m_r.bottomRightCorner<2, 2>();
      Eigen::Matrix2d outer = b.transpose() * b;
      outer.diagonal().array() -= m_minSingular * m_minSingular;
      const Eigen::Vector2d d = outer.col(outer(0, 0) >= outer(1, 1) ? 0 : 1).normalized();
      a.tail<2>() = d * (b * d).dot(right.tail<2>()) / (m_maxSingular * m_maxSingular);
    }
    a[0] = (right[0] - m_r(0, 1) * a[1] - m_r(0, 2) * a[2]) / m_r(0, 0);
    return {a[0], a[1], a[2]};
  }

private:
  /// Replaces column k by its reflection vector v (0 for a zero column); reflects later columns.
  void reflect(Eigen::Index k) {
    const Eigen::Index above = std::min(k, m_v.rows());
    auto v = m_v.col(k);
    m_r.col(k).head(above) = v.head(above);
    v.head(above).setZero();
    const double length = v.norm();
    if (length == 0.0)
      return;
    m_r(k, k) = -std::copysign(length, v[k]);
    v[k] -= m_r(k, k);
    v *= std::sqrt(2.0) / v.norm();
    for (Eigen::Index later = k + 1; later < 3; ++later)
      m_v.col(later) -= v.dot(m_v.col(later)) * v;
  }

  Eigen::MatrixX3d m_v; ///< v0, v1, v2
  Eigen::Matrix3d m_r = Eigen::Matrix3d::Zero();
  double m_maxSingular, m_minSingular; ///< singular values of R without its first row and column
  int m_rank;                          ///< at least 1
};

Eigen::MatrixX2d toMatrix(const std::vector<Vec2>& points) {
  Eigen::MatrixX2d matrix(std::ssize(points), 2);
  for (std::size_t i = 0; i < points.size(); ++i)
    matrix.row(static_cast<Eigen::Index>(i)) << points[i].x(), points[i].y();
  return matrix;
}

/// Sites in the unit disk, and their values.
struct Samples {
  std::vector<Vec2> sites;
  std::vector<double> values;
};

/// Merges sites that are too close for this lambda into the first of them, with their mean value.
Samples mergeSites(const Samples& samples, double lambda) {
  Samples distinct;
  std::vector<double> counts;
  for (std::size_t i = 0; i < samples.sites.size(); ++i) {
    const auto isNear = [&, site = samples.sites[i]](const Vec2& other) {
      const Eigen::Array<double, 1, 1> squared((site - other).squaredNorm());
      return squared[0] < 1e-6 && lambda - phi(squared)[0] < minEigenvalue; // phi < 0 if close
    };
    const auto found = std::ranges::find_if(distinct.sites, isNear);
    const auto at = static_cast<std::size_t>(found - distinct.sites.begin());
    if (found == distinct.sites.end()) {
      distinct.sites.push_back(samples.sites[i]);
      distinct.values.push_back(0.0);
      counts.push_back(0.0);
    }
    counts[at] += 1.0;
    distinct.values[at] += (samples.values[i] - distinct.values[at]) / counts[at];
  }
  return distinct;
}

} // namespace

ThinPlateSpline::ThinPlateSpline(std::span<const Vec2> sites, std::span<const double> values,
                                 double smoothing) {
  if (sites.empty())
    return;
  Samples samples{toUnitDisk(sites), {values.begin(), values.end()}};
  m_lambda = smoothing > 0.0 ? (1.0 - smoothing) / smoothing * m_invScale * m_invScale : infinity;
  if (m_lambda < minEigenvalue)
    samples = mergeSites(samples, m_lambda);
  fit(samples.sites,
      Eigen::Map<const Eigen::VectorXd>(samples.values.data(), std::ssize(samples.values)));
}

std::vector<Vec2> ThinPlateSpline::toUnitDisk(std::span<const Vec2> sites) {
  m_origin = sites[0];
  const auto count = static_cast<double>(sites.size());
  Vec2 centroid = Vec2::Zero();
  for (const Vec2& site : sites)
    centroid += (site - m_origin) / count;
  double scale = 0.0;
  for (const Vec2& site : sites)
    scale = std::max(scale, (site - m_origin - centroid).norm());
  if (scale > std::max(coordinateRounding(m_origin), 1e-100)) // else they coincide
    m_invScale = 1.0 / scale;
  m_centroid = m_invScale * centroid;
  std::vector<Vec2> inDisk;
  inDisk.reserve(sites.size());
  for (const Vec2& site : sites)
    inDisk.push_back((site - m_origin) * m_invScale - m_centroid);
  return inDisk;
}

void ThinPlateSpline::fit(const std::vector<Vec2>& sites, const Eigen::VectorXd& values) {
  const Eigen::MatrixX2d u = toMatrix(sites);
  const PolynomialQr p(u, std::max(1e-9, coordinateRounding(m_origin) * m_invScale));
  m_plane = p.solveLeastSquares(values); // final if lambda is infinite or no plane is determined
  const Eigen::Index n = values.size();
  if (!std::isfinite(m_lambda) || p.rank() < 3 || n == 3)
    return;

  const Eigen::MatrixXd k = makeKernelMatrix(u, m_lambda);
  Eigen::VectorXd w = p.applyQTransposed(values);
  w.head<3>().setZero();
  w.tail(n - 3) = p.projectToNullSpace(k).ldlt().solve(w.tail(n - 3)).eval();
  w = p.applyQ(w);
  m_plane = p.solveLeastSquares(values - k * w);
  for (Eigen::Index i = 0; i < n; ++i) {
    const Vec2& site = sites[static_cast<std::size_t>(i)];
    m_terms.push_back({site, w[i]});
    m_moment += w[i] * site.squaredNorm();
  }
}

double ThinPlateSpline::operator()(const Vec2& x) const {
  double value = 0.0;
  evaluateRow({&x.x(), 1}, x.y(), {&value, 1});
  return value;
}

void ThinPlateSpline::evaluateRow(std::span<const double> x, double y,
                                  std::span<double> values) const {
  const double v = toDiskY(y);
  for (Eigen::Index begin = 0; begin < std::ssize(x); begin += maxColumns) {
    const Eigen::Index count = std::min(maxColumns, std::ssize(x) - begin);
    const Points u =
        (Eigen::Map<const Points>(x.data() + begin, count) - m_origin.x()) * m_invScale -
        m_centroid.x();
    const Points squaredNorm = u.square() + v * v;
    Points sum = m_plane[0] + m_plane[2] * v + m_plane[1] * u;
    Points near = sum;
    addKernels(m_terms, toSpan(u), v, toSpan(near));
    if (!(squaredNorm <= farRadiusSquared).all())
      near = (squaredNorm <= farRadiusSquared).select(near, sum + evaluateFarTerms(u, v));
    Eigen::Map<Points>(values.data() + begin, count) = near;
  }
}

void ThinPlateSpline::evaluateTile(std::span<const double> x, std::span<const double> y,
                                   double tolerance, std::span<double> values) const {
  const Disk disk = boundTile(x, y);
  std::vector<KernelTerm> near, far;
  std::ranges::partition_copy(m_terms, std::back_inserter(far), std::back_inserter(near),
                              [&](const KernelTerm& term) { return disk.isFar(term); });
  const double extent = disk.center.norm() + disk.radius; // bounds |u| in the tile
  const bool isSummable = near.empty() || extent * extent <= farRadiusSquared;
  std::optional<LocalExpansion> expansion;
  if (isSummable)
    expansion = LocalExpansion::make(far, disk.center, disk.radius, tolerance);
  if (!expansion) {
    for (std::size_t row = 0; row < y.size(); ++row)
      evaluateRow(x, y[row], values.subspan(row * x.size(), x.size()));
    return;
  }
  expansion->addPlane(m_plane[0] + Vec2(m_plane.y(), m_plane.z()).dot(disk.center), m_plane[1],
                      m_plane[2]);
  Points u(std::ssize(x));
  for (Eigen::Index i = 0; i < u.size(); ++i)
    u[i] = toDiskX(x[static_cast<std::size_t>(i)]);
  const Points fromCenter = u - disk.center.x();
  for (std::size_t row = 0; row < y.size(); ++row) {
    const double v = toDiskY(y[row]);
    const auto rowValues = values.subspan(row * x.size(), x.size());
    expansion->evaluateRow({fromCenter.data(), x.size()}, v - disk.center.y(), rowValues);
    addKernels(near, toSpan(u), v, rowValues);
  }
}

std::int64_t ThinPlateSpline::countNearTerms(std::span<const double> x,
                                             std::span<const double> y) const {
  const Disk disk = boundTile(x, y);
  return std::ranges::count_if(m_terms, [&](const KernelTerm& term) { return !disk.isFar(term); });
}

ThinPlateSpline::Disk ThinPlateSpline::boundTile(std::span<const double> x,
                                                 std::span<const double> y) const {
  const Vec2 first(toDiskX(x.front()), toDiskY(y.front()));
  const Vec2 last(toDiskX(x.back()), toDiskY(y.back()));
  return {0.5 * (first + last), 0.5 * (last - first).norm()};
}

ThinPlateSpline::Points ThinPlateSpline::evaluateFarTerms(const Points& u, double v) const {
  const Points squaredNorm = (u.square() + v * v).max(farRadiusSquared);
  Points sum = m_moment * squaredNorm.log();
  Points excess(u.size());
  for (const KernelTerm& term : m_terms) {
    const Vec2& site = term.site;
    excess = site.squaredNorm() - 2.0 * (site.x() * u + site.y() * v);
    sum += term.weight * (squaredNorm + excess) * (excess / squaredNorm).log1p();
  }
  return sum;
}

} // namespace fenestra::core
