#include "scene/AutomaticView.h"

#include "model/medium/Medium.h"

#include <tbb/parallel_for.h>

namespace fenestra::core {
namespace {

/// Point n of the R2 sequence, which fills the unit square evenly without alignment to its axes
/// (Roberts 2018, "The unreasonable effectiveness of quasirandom sequences").
Vec2 r2Point(std::size_t n) {
  const auto fraction = [](double x) { return x - std::floor(x); };
  const auto i = static_cast<double>(n) + 0.5;
  return {fraction(i * 0.7548776662466927), fraction(i * 0.5698402909980532)};
}

bool isFocus(const Mask& focus, const Vec3& world) {
  const Vec3 nearest = (focus.grid.worldToIndex * world).array().round();
  const Size3& size = focus.grid.size;
  if ((nearest.array() < 0.0).any() || (nearest.array() >= size.cast<double>().array()).any())
    return false;
  return focus.voxels[linearIndex(nearest.cast<std::int64_t>(), size)] >= focus.threshold();
}

} // namespace

/// Depths at which parallel rays hit the focus.
class ViewScorer::FocusDepths {
public:
  FocusDepths(const FocusCells& cells, const Domain& domain, const Vec3& fromTarget,
              std::size_t rays)
      : m_cells(cells), m_domain(domain), m_frame(fromTarget) {
    const Box box = cells.box();
    const Affine cellToWorld = cells.cellToWorld();
    m_center = cellToWorld * box.center();
    for (int i = 0; i < 8; ++i)
      m_half = m_half.cwiseMax(toLocal(cellToWorld * box.corner(i)).cwiseAbs());
    trace(rays);
  }

  /// Projected area of the focus, mm².
  double area() const { return 4.0 * m_half.x() * m_half.y() * hitFraction(); }
  double hitFraction() const { return m_hitCount / m_rays; }
  /// Depth of the clip surface, mm from the focus center, at a point in local coordinates.
  double surfaceDepth(const Vec3& point) const {
    const Vec2 at = binPosition(point.head<2>());
    if ((at.array() < 0.0).any() || (at.array() >= double{bins}).any())
      return m_mean;
    const Bin& bin = m_bins[binIndex(at)];
    return bin.count > 0.0 ? bin.sum / bin.count : m_mean;
  }
  /// Coordinates from the focus center, mm: two across the view, and the depth.
  Vec3 toLocal(const Vec3& world) const {
    const Vec3 across = m_frame.toLocal(world - m_center);
    return {across.x(), across.y(), -across.z()};
  }

private:
  static constexpr int bins = 32; ///< along each axis
  struct Bin {
    double sum = 0.0, count = 0.0; ///< of depths, mm
  };

  Vec2 binPosition(const Vec2& across) const {
    return bins * (0.5 * (across.cwiseQuotient(m_half.head<2>()).array() + 1.0)).matrix();
  }
  static std::size_t binIndex(const Vec2& at) {
    return static_cast<std::size_t>(at.x()) + bins * static_cast<std::size_t>(at.y());
  }

  void trace(std::size_t rays) {
    m_rays = static_cast<double>(rays);
    for (std::size_t next = 0; next < rays;) {
      FocusRays batch;
      std::array<Vec2, FocusRays::capacity> across;
      for (; next < rays && !batch.isFull(); ++next) {
        const Vec2 even = 2.0 * r2Point(next) - Vec2::Ones();
        const Vec2 at = even.cwiseProduct(m_half.head<2>());
        across[batch.size] = at;
        add(batch, at);
      }
      m_cells.findHits(batch);
      for (std::size_t i = 0; i < batch.size; ++i)
        if (batch.hitT[i] < infinity)
          addHit(across[i], batch.hitT[i] - m_half.z());
    }
    m_mean = m_hitCount > 0.0 ? m_mean / m_hitCount : 0.0;
  }

  /// Adds the part inside the domain of a ray that starts in front of the focus.
  void add(FocusRays& batch, const Vec2& across) const {
    const Vec3 start = m_center + m_frame.toWorld({across.x(), across.y(), m_half.z()});
    const Ray world{start, -m_frame.normal};
    const Interval inDomain = m_domain.clip(transformRay(m_domain.grid().worldToIndex, world));
    const Ray ray = transformRay(m_cells.worldToCell(), world);
    const Interval range = m_cells.box().clip(ray, inDomain);
    if (!range.isEmpty())
      batch.add(ray, range);
  }

  void addHit(const Vec2& across, double depth) {
    m_hitCount += 1.0;
    m_mean += depth;
    Bin& bin = m_bins[binIndex(binPosition(across).cwiseMin(bins - 1e-6).cwiseMax(0.0))];
    bin.sum += depth;
    bin.count += 1.0;
  }

  const FocusCells& m_cells;
  const Domain& m_domain;
  Frame m_frame; ///< normal: toward the camera
  Vec3 m_center;
  Vec3 m_half = Vec3::Zero(); ///< half extents of the cells' box, mm
  double m_rays = 0.0, m_hitCount = 0.0;
  double m_mean = 0.0; ///< mean depth, mm; a sum until trace() ends
  std::array<Bin, std::size_t{bins} * bins> m_bins{};
};

ViewScorer::ViewScorer(const Volume& volume, const Domain& domain, const TransferFunction& transfer,
                       const Mask& focus)
    : m_domain(domain), m_focus(focus) {
  constexpr double cellsPerEdge = 32.0;
  const Grid& grid = volume.grid;
  const Vec3 edges = grid.spacing().cwiseProduct(grid.size.cast<double>());
  m_cellEdge = edges.maxCoeff() / cellsPerEdge;
  const Size3 count =
      (edges / m_cellEdge).array().round().max(1.0).cast<std::int64_t>().min(grid.size.array());
  std::vector<std::vector<ContextCell>> layers(static_cast<std::size_t>(count.z()));
  std::visit(
      [&](const auto& voxels) {
        const Medium medium(grid, voxels, transfer);
        const Vec3 cell = grid.size.cast<double>().cwiseQuotient(count.cast<double>());
        tbb::parallel_for(std::int64_t{0}, count.z(), [&](std::int64_t z) {
          for (std::int64_t y = 0; y < count.y(); ++y)
            for (std::int64_t x = 0; x < count.x(); ++x) {
              const Vec3 middle = Size3(x, y, z).cast<double>() + Vec3::Constant(0.5);
              const Vec3 index = cell.cwiseProduct(middle) - Vec3::Constant(0.5);
              const Vec3 world = grid.indexToWorld * index;
              if (!m_domain.contains(index) || isFocus(focus, world))
                continue;
              const double opacity = -std::expm1(-m_cellEdge * medium.extinction(index));
              if (opacity > 0.0)
                layers[static_cast<std::size_t>(z)].push_back({world, opacity});
            }
        });
      },
      volume.voxels);
  for (const std::vector<ContextCell>& layer : layers)
    m_context.insert(m_context.end(), layer.begin(), layer.end());
}

double ViewScorer::removedFraction(const FocusDepths& focus) const {
  double removed = 0.0, all = 0.0;
  for (const ContextCell& cell : m_context) {
    const Vec3 at = focus.toLocal(cell.center);
    const double inFront = (focus.surfaceDepth(at) - at.z()) / m_cellEdge;
    // A cell that the surface cuts counts in part.
    removed += cell.weight * std::clamp(inFront + 0.5, 0.0, 1.0);
    all += cell.weight;
  }
  return all > 0.0 ? removed / all : 0.0;
}

ViewScore ViewScorer::operator()(const Vec3& fromTarget, std::size_t rays) const {
  const FocusDepths focus(m_focus, m_domain, fromTarget, rays);
  ViewScore score{.area = focus.area(), .hitFraction = focus.hitFraction()};
  if (score.area > 0.0)
    score.removedFraction = removedFraction(focus);
  const double preference = 1.0 + 0.05 * fromTarget.y() - 0.1 * fromTarget.z() * fromTarget.z();
  score.score = score.area * (1.0 - score.removedFraction) * preference;
  return score;
}

} // namespace fenestra::core
