#include "clipping/ThinPlateSpline.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <Eigen/SVD>

#include <algorithm>

namespace fenestra {

namespace {

/// Keeps the logarithm finite at a site, where its factor is 0.
constexpr double tiny = 1e-300;

/// lambda - phi below which two sites are not told apart: it is the least eigenvalue that they
/// cause, and a few digits of the solution have to survive it.
constexpr double indistinct = 1e-12;

/// Squared radii beyond which the sum of the kernels loses too much to cancellation.
constexpr double farSquared = 256.0;

/// How far, in mm, the coordinates of a site may be from what they stand for.
double roundingAt(const Vec2& site) {
  return 8.0 * std::numeric_limits<double>::epsilon() * site.lpNorm<Eigen::Infinity>();
}

/// phi of squared distances.
template <typename Derived>
auto kernel(const Eigen::ArrayBase<Derived>& squared) {
  return squared * (squared + tiny).log();
}

template <typename Array>
auto spanOf(Array& array) {
  return std::span(array.data(), static_cast<std::size_t>(array.size()));
}

/// K + lambda I.
Eigen::MatrixXd kernelMatrix(const Eigen::MatrixX2d& sites, double lambda) {
  Eigen::MatrixXd k(sites.rows(), sites.rows());
  for (Eigen::Index i = 0; i < sites.rows(); ++i)
    k.col(i) = kernel((sites.rowwise() - sites.row(i)).rowwise().squaredNorm().array());
  k.diagonal().array() += lambda;
  return k;
}

/// P.
Eigen::MatrixX3d polynomials(const Eigen::MatrixX2d& sites) {
  Eigen::MatrixX3d p(sites.rows(), 3);
  p << Eigen::VectorXd::Ones(sites.rows()), sites;
  return p;
}

using PolynomialsQr = Eigen::HouseholderQR<Eigen::MatrixX3d>;

/// Q2' (K + lambda I) Q2, where the columns of Q2 span the null space of P'.
Eigen::MatrixXd inNullSpace(const Eigen::MatrixXd& k, const PolynomialsQr& qr) {
  Eigen::MatrixXd turned = k;
  turned.applyOnTheLeft(qr.householderQ().adjoint());
  turned.applyOnTheRight(qr.householderQ());
  const Eigen::Index n = k.rows() - 3;
  return turned.bottomRightCorner(n, n);
}

Eigen::MatrixX2d rows(const std::vector<Vec2>& points) {
  Eigen::MatrixX2d matrix(std::ssize(points), 2);
  for (std::size_t i = 0; i < points.size(); ++i)
    matrix.row(static_cast<Eigen::Index>(i)) = points[i].transpose();
  return matrix;
}

/// Sites of the unit disc, and their values.
struct Samples {
  std::vector<Vec2> sites;
  std::vector<double> values;
};

/// Sites that lambda leaves indistinct become the first of them, with their mean value: so those
/// that stay are as far apart as they have to be.
Samples merged(const Samples& samples, double lambda) {
  Samples kept;
  std::vector<double> counts;
  for (std::size_t i = 0; i < samples.sites.size(); ++i) {
    const auto isNear = [&, site = samples.sites[i]](const Vec2& other) {
      const Eigen::Array<double, 1, 1> squared((site - other).squaredNorm());
      return squared[0] < 1e-6 && lambda - kernel(squared)[0] < indistinct; // phi < 0 nearby
    };
    const auto found = std::ranges::find_if(kept.sites, isNear);
    const auto at = static_cast<std::size_t>(found - kept.sites.begin());
    if (found == kept.sites.end()) {
      kept.sites.push_back(samples.sites[i]);
      kept.values.push_back(0.0);
      counts.push_back(0.0);
    }
    counts[at] += 1.0;
    kept.values[at] += (samples.values[i] - kept.values[at]) / counts[at];
  }
  return kept;
}

} // namespace

ThinPlateSpline::ThinPlateSpline(std::span<const Vec2> sites, std::span<const double> values,
                                 double smoothing) {
  if (sites.empty())
    return;
  Samples samples{toUnitDisc(sites), {values.begin(), values.end()}};
  m_lambda = smoothing > 0.0 ? (1.0 - smoothing) / smoothing * m_perScale * m_perScale : infinity;
  if (m_lambda < indistinct)
    samples = merged(samples, m_lambda);
  fit(samples.sites,
      Eigen::Map<const Eigen::VectorXd>(samples.values.data(), std::ssize(samples.values)));
}

std::vector<Vec2> ThinPlateSpline::toUnitDisc(std::span<const Vec2> sites) {
  m_origin = sites[0];
  const auto count = static_cast<double>(sites.size());
  Vec2 centroid = Vec2::Zero();
  for (const Vec2& site : sites)
    centroid += (site - m_origin) / count;
  double scale = 0.0;
  for (const Vec2& site : sites)
    scale = std::max(scale, (site - m_origin - centroid).norm());
  if (scale > std::max(roundingAt(m_origin), 1e-100)) // else they coincide
    m_perScale = 1.0 / scale;
  m_centroid = m_perScale * centroid;
  std::vector<Vec2> inDisc;
  inDisc.reserve(sites.size());
  for (const Vec2& site : sites)
    inDisc.push_back((site - m_origin) * m_perScale - m_centroid);
  return inDisc;
}

void ThinPlateSpline::fit(const std::vector<Vec2>& sites, const Eigen::VectorXd& values) {
  const Eigen::MatrixX2d u = rows(sites);
  const Eigen::MatrixX3d p = polynomials(u);
  // The least-squares polynomial, the flattest where several are: what is left where lambda is
  // infinite or the sites do not determine a plane.
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd =
      Eigen::JacobiSVD<Eigen::MatrixXd>(p, Eigen::ComputeThinU | Eigen::ComputeThinV)
          .setThreshold(std::max(1e-9, roundingAt(m_origin) * m_perScale));
  m_plane = svd.solve(values);
  const Eigen::Index n = values.size();
  if (!std::isfinite(m_lambda) || svd.rank() < 3 || n == 3)
    return;

  const Eigen::MatrixXd k = kernelMatrix(u, m_lambda);
  const PolynomialsQr qr(p);
  Eigen::VectorXd w = qr.householderQ().adjoint() * values;
  w.head<3>().setZero();
  w.tail(n - 3) = inNullSpace(k, qr).ldlt().solve(w.tail(n - 3)).eval();
  w.applyOnTheLeft(qr.householderQ());
  m_plane = svd.solve(values - k * w);
  for (Eigen::Index i = 0; i < n; ++i) {
    const Vec2& site = sites[static_cast<std::size_t>(i)];
    m_terms.push_back({site, w[i]});
    m_moment += w[i] * site.squaredNorm();
  }
}

double ThinPlateSpline::conditionNumber() const {
  if (m_terms.empty())
    return 1.0;
  std::vector<Vec2> sites;
  for (const KernelTerm& term : m_terms)
    sites.push_back(term.site);
  const Eigen::MatrixX2d u = rows(sites);
  const PolynomialsQr qr(polynomials(u));
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> spectrum(
      inNullSpace(kernelMatrix(u, m_lambda), qr), Eigen::EigenvaluesOnly);
  return spectrum.eigenvalues().maxCoeff() / spectrum.eigenvalues().minCoeff();
}

double ThinPlateSpline::operator()(const Vec2& x) const {
  double value = 0.0;
  evaluateRow({&x.x(), 1}, x.y(), {&value, 1});
  return value;
}

void ThinPlateSpline::evaluateRow(std::span<const double> x, double y,
                                  std::span<double> values) const {
  const double v = toDiscY(y);
  for (Eigen::Index begin = 0; begin < std::ssize(x); begin += mostColumns) {
    const Eigen::Index count = std::min(mostColumns, std::ssize(x) - begin);
    const Points u =
        (Eigen::Map<const Points>(x.data() + begin, count) - m_origin.x()) * m_perScale -
        m_centroid.x();
    const Points squaredNorm = u.square() + v * v;
    Points sum = m_plane[0] + m_plane[2] * v + m_plane[1] * u;
    Points near = sum;
    addKernels(m_terms, spanOf(u), v, spanOf(near));
    if (!(squaredNorm <= farSquared).all())
      near = (squaredNorm <= farSquared).select(near, sum + farTerms(u, v));
    Eigen::Map<Points>(values.data() + begin, count) = near;
  }
}

void ThinPlateSpline::evaluateTile(std::span<const double> x, std::span<const double> y,
                                   double tolerance, std::span<double> values) const {
  const Disc disc = discAround(x, y);
  std::vector<KernelTerm> near = m_terms, far;
  const auto isNear = [&](const KernelTerm& term) { return !disc.isFar(term); };
  const auto firstFar = std::stable_partition(near.begin(), near.end(), isNear);
  far.assign(firstFar, near.end());
  near.erase(firstFar, near.end());
  const double reach = disc.center.norm() + disc.radius;
  const bool isSummable = near.empty() || reach * reach <= farSquared;
  std::optional<LocalExpansion> expansion;
  if (isSummable)
    expansion = LocalExpansion::of(far, disc.center, disc.radius, tolerance);
  if (!expansion) {
    for (std::size_t row = 0; row < y.size(); ++row)
      evaluateRow(x, y[row], values.subspan(row * x.size(), x.size()));
    return;
  }
  expansion->addPlane(m_plane[0] + m_plane.tail<2>().dot(disc.center), m_plane[1], m_plane[2]);
  Points u(std::ssize(x));
  for (Eigen::Index i = 0; i < u.size(); ++i)
    u[i] = toDiscX(x[static_cast<std::size_t>(i)]);
  const Points fromCenter = u - disc.center.x();
  for (std::size_t row = 0; row < y.size(); ++row) {
    const double v = toDiscY(y[row]);
    const auto ofRow = values.subspan(row * x.size(), x.size());
    expansion->evaluateRow({fromCenter.data(), x.size()}, v - disc.center.y(), ofRow);
    addKernels(near, spanOf(u), v, ofRow);
  }
}

std::int64_t ThinPlateSpline::termsNear(std::span<const double> x,
                                        std::span<const double> y) const {
  const Disc disc = discAround(x, y);
  return std::ranges::count_if(m_terms, [&](const KernelTerm& term) { return !disc.isFar(term); });
}

ThinPlateSpline::Disc ThinPlateSpline::discAround(std::span<const double> x,
                                                  std::span<const double> y) const {
  const Vec2 first(toDiscX(x.front()), toDiscY(y.front()));
  const Vec2 last(toDiscX(x.back()), toDiscY(y.back()));
  return {0.5 * (first + last), 0.5 * (last - first).norm()};
}

ThinPlateSpline::Points ThinPlateSpline::farTerms(const Points& u, double v) const {
  const Points squaredNorm = (u.square() + v * v).max(farSquared);
  Points sum = m_moment * squaredNorm.log();
  Points excess(u.size());
  for (const KernelTerm& term : m_terms) {
    const Vec2& site = term.site;
    excess = site.squaredNorm() - 2.0 * (site.x() * u + site.y() * v);
    sum += term.weight * (squaredNorm + excess) * (excess / squaredNorm).log1p();
  }
  return sum;
}

} // namespace fenestra
