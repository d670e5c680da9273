// Automatic smoothing of label maps: an organ whose true surface is known (stairs, volume), thin
// parts and narrow gaps.

#include "ClippingTesting.h"
#include "files/segments/SegmentationReader.h"

#include <gtest/gtest.h>

#include <functional>
#include <random>

namespace fenestra::core::AutomaticSmoothingTests {
using namespace testing_clipping;

namespace {

using Shape = std::function<bool(const Vec3&)>;

/// Grid of `spacing` mm that fills a cube of `edge` mm around the origin.
Grid makeCube(double edge, const Vec3& spacing) {
  const Vec3 size = (edge * spacing.cwiseInverse()).array().round();
  return makeCenteredGrid(size.cast<std::int64_t>(), spacing);
}

/// Labels on `grid`, each that of the nearest voxel of a grid of `native` mm.
Segmentation makeLabels(const Grid& grid, const Vec3& native, const Shape& shape) {
  const Vec3 shift = native == grid.spacing() ? grid.indexToWorld.translation() : 0.13 * native;
  LargeArray<std::uint8_t> labels;
  for (std::int64_t z = 0; z < grid.size.z(); ++z)
    for (std::int64_t y = 0; y < grid.size.y(); ++y)
      for (std::int64_t x = 0; x < grid.size.x(); ++x) {
        const Vec3 p = grid.indexToWorld * Size3(x, y, z).cast<double>();
        const Vec3 voxel = (p - shift).cwiseQuotient(native).array().round();
        labels.push_back(shape(voxel.cwiseProduct(native) + shift));
      }
  return {"labels", grid, 1, std::move(labels), {{"1", "organ"}}};
}

Mask smoothLabels(const Segmentation& labels) {
  return labels.makeFocusMask({"organ"}, labels.grid(), {.smoothing = std::nullopt});
}

/// Trilinear indicator at a point, world mm, 0 to 1.
double evalMask(const Mask& mask, const Vec3& world) {
  const Vec3 last = (mask.grid.size.array() - 1).cast<double>();
  const Vec3 at = (mask.grid.worldToIndex * world).cwiseMax(0.0).cwiseMin(last);
  const Size3 cell = at.cast<std::int64_t>().cwiseMin((mask.grid.size.array() - 2).matrix());
  const Vec3 f = at - cell.cast<double>();
  double sum = 0.0;
  for (int corner = 0; corner < 8; ++corner) {
    const Size3 offset(corner & 1, corner >> 1 & 1, corner >> 2);
    double weight = 1.0;
    for (int axis = 0; axis < 3; ++axis)
      weight *= offset[axis] ? f[axis] : 1.0 - f[axis];
    sum += weight * mask.voxels[linearIndex(cell + offset, mask.grid.size)];
  }
  return sum / mask.maxValue;
}

/// Length of the part of a segment where the indicator is at least 1/2, mm.
double measureInside(const Mask& mask, const Vec3& from, const Vec3& to) {
  constexpr int steps = 2000;
  int inside = 0;
  for (int i = 0; i < steps; ++i)
    inside += evalMask(mask, from + (i + 0.5) / steps * (to - from)) >= 0.5;
  return (to - from).norm() * inside / steps;
}

double measureLabels(const Mask& mask) {
  return static_cast<double>(mask.count) * mask.grid.spacing().prod();
}

/// Volume inside the surface, by a random point per mm^3, mm^3.
double measureVolume(const Mask& mask) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> jitter(-0.5, 0.5);
  const double voxel = mask.grid.spacing().prod();
  const auto points = static_cast<int>(std::ceil(voxel));
  std::int64_t inside = 0;
  for (std::int64_t z = 0; z < mask.grid.size.z(); ++z)
    for (std::int64_t y = 0; y < mask.grid.size.y(); ++y)
      for (std::int64_t x = 0; x < mask.grid.size.x(); ++x)
        for (int i = 0; i < points; ++i) {
          const Vec3 offset(jitter(random), jitter(random), jitter(random));
          const Vec3 at = Size3(x, y, z).cast<double>() + offset;
          inside += evalMask(mask, mask.grid.indexToWorld * at) >= 0.5;
        }
  return static_cast<double>(inside) * voxel / points;
}

// ---- an organ

/// Positive inside an organ of about 70 mm with ridges and waves, about its distance there, mm.
double evalOrgan(const Vec3& p) {
  const double radius = p.cwiseQuotient(Vec3(1.15, 0.9, 0.8)).norm();
  const double angle = std::atan2(p.y(), p.x()), fade = p.z() / 25.0;
  return 38.0 + 3.0 * std::sin(3.0 * angle + 0.3) * std::exp(-fade * fade) +
         2.0 * std::sin(p.z() / 9.0) + 1.5 * std::sin(p.x() / 7.0) - radius;
}

/// Gradient of a function by central differences.
template <typename Function>
Vec3 differentiate(const Function& function, const Vec3& p, double step) {
  Vec3 gradient;
  for (int axis = 0; axis < 3; ++axis) {
    const Vec3 offset = step * Vec3::Unit(axis);
    gradient[axis] = (function(p + offset) - function(p - offset)) / (2.0 * step);
  }
  return gradient;
}

struct SurfaceErrors {
  double normal = 0.0;   ///< rms, degrees
  double distance = 0.0; ///< rms, mm
};

/// Errors of the mask's surface at points on the true one.
SurfaceErrors measureOrgan(const Mask& mask) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  constexpr int count = 1500;
  double angles = 0.0, distances = 0.0;
  for (int i = 0; i < count; ++i) {
    const Vec3 direction = Vec3(normal(random), normal(random), normal(random)).normalized();
    if (direction.head<2>().norm() < 0.1)
      continue; // the shape is not smooth at its poles
    double low = 0.0, high = 59.0;
    for (int step = 0; step < 40; ++step)
      (evalOrgan(0.5 * (low + high) * direction) > 0.0 ? low : high) = 0.5 * (low + high);
    const Vec3 point = low * direction,
               outward = -differentiate(evalOrgan, point, 1e-3).normalized();
    const auto evalAt = [&](double t) { return evalMask(mask, point + t * outward) - 0.5; };
    double nearest = 6.0; // mm
    for (double t = -6.0; t < 6.0; t += 0.1)
      if (evalAt(t) > 0.0 && evalAt(t + 0.1) <= 0.0) {
        const double crossing = t + 0.1 * evalAt(t) / (evalAt(t) - evalAt(t + 0.1));
        if (std::abs(crossing) < std::abs(nearest))
          nearest = crossing;
      }
    const Vec3 found = point + nearest * outward;
    const double step = 0.5 * mask.grid.spacing().minCoeff();
    const Vec3 gradient =
        differentiate([&](const Vec3& p) { return evalMask(mask, p); }, found, step);
    const double cosine = std::clamp(-gradient.normalized().dot(outward), -1.0, 1.0);
    angles += std::pow(std::acos(cosine) * 180.0 / pi, 2);
    distances += nearest * nearest;
  }
  return {std::sqrt(angles / count), std::sqrt(distances / count)};
}

TEST(AutomaticSmoothing, OrganHasNoStairsAndItsVolume) {
  const Vec3 ct(0.9355, 0.9355, 2.5), middle = Vec3::Constant(1.5), coarse = Vec3::Constant(3.0);
  struct Case {
    Vec3 native, spacing;
  };
  for (const auto& [native, spacing] :
       {Case{ct, ct}, Case{middle, ct}, Case{coarse, ct}, Case{coarse, coarse}}) {
    const Segmentation labels = makeLabels(makeCube(120.0, spacing), native,
                                           [](const Vec3& p) { return evalOrgan(p) > 0.0; });
    const Mask plain = labels.makeMask(labels.segments(), labels.grid(), {});
    const Mask smooth = smoothLabels(labels);
    const SurfaceErrors errors = measureOrgan(smooth);
    const double change = measureVolume(smooth) / measureLabels(plain) - 1.0;
    const double edge = native.x();
    EXPECT_NEAR(smooth.smoothing, 1.25 * edge, 0.05 * edge);
    EXPECT_LT(errors.normal, 6.0) << edge;
    EXPECT_LT(errors.distance, 0.2 * edge);
    EXPECT_LT(std::abs(change), 0.003) << edge;
    EXPECT_NEAR(smooth.volumeChange, change, 0.003);
  }
}

// ---- thin parts and narrow gaps

Segmentation makePart(double voxel, double native, const Shape& shape) {
  return makeLabels(makeCube(54.0, Vec3::Constant(voxel)), Vec3::Constant(native), shape);
}

TEST(AutomaticSmoothing, FissureOf3mmStaysOpen) {
  for (const auto& [voxel, native] : {std::pair(0.5, 0.5), std::pair(1.0, 1.0), std::pair(1.5, 1.5),
                                      std::pair(3.0, 3.0), std::pair(1.0, 3.0)}) {
    const Segmentation labels = makePart(voxel, native, [](const Vec3& p) {
      return p.norm() < 24.0 && std::abs(p.x() + 0.1) >= 1.5;
    });
    const Mask smooth = smoothLabels(labels);
    for (const double z : {-9.0, -4.1, 0.3, 6.0}) {
      const double width = 6.0 - measureInside(smooth, Vec3(-3.0, 1.2, z), Vec3(3.0, 1.2, z));
      EXPECT_GT(width, 2.0) << voxel << ' ' << native;
      EXPECT_LT(width, 3.5);
    }
    EXPECT_LT(std::abs(smooth.volumeChange), 0.003);
  }
}

TEST(AutomaticSmoothing, DefectOfCartilageKeepsItsDepth) {
  for (const double voxel : {0.5, 1.0, 1.5})
    for (const bool isRound : {false, true}) {
      // Cartilage 2 mm thick on a plane; a groove or pit 5 mm wide and 1 mm deep. In voxels of
      // 1.5 mm they are 3 and 1.5 mm.
      const double base = 0.5 * voxel - 0.25;
      const Segmentation labels = makePart(voxel, voxel, [&](const Vec3& p) {
        const bool isDefect = (isRound ? p.head<2>().norm() : std::abs(p.x())) < 2.5;
        const double height = p.z() - base;
        return height >= 0.0 && height < (isDefect ? 1.0 : 2.0) && p.head<2>().norm() < 20.0;
      });
      const Mask smooth = smoothLabels(labels);
      const auto measureThickness = [&](double x) {
        return measureInside(smooth, Vec3(x, 0.0, -5.0), Vec3(x, 0.0, 5.0));
      };
      const double thickness = measureThickness(10.0), depth = thickness - measureThickness(0.0);
      const double deepest = voxel > 1.0 ? 1.5 : 1.0;
      EXPECT_NEAR(thickness / (2.0 * deepest), 1.0, 0.05) << voxel;
      EXPECT_NEAR(depth, deepest, 0.2 * deepest) << voxel;
      EXPECT_LT(std::abs(smooth.volumeChange), 0.003);
    }
}

/// Number of voxels of the labels from which the smoothed mask's surface is more than a voxel away.
std::int64_t countVanished(const Mask& labels, const Mask& smooth) {
  std::int64_t vanished = 0;
  for (std::int64_t i = 0; i < labels.grid.voxelCount(); ++i) {
    if (labels.voxels[static_cast<std::size_t>(i)] == 0)
      continue;
    const Size3& size = labels.grid.size;
    const Size3 voxel(i % size.x(), i / size.x() % size.y(), i / (size.x() * size.y()));
    double greatest = 0.0;
    for (int neighbor = 0; neighbor < 27; ++neighbor) {
      const Size3 offset(neighbor % 3 - 1, neighbor / 3 % 3 - 1, neighbor / 9 - 1);
      const Vec3 at = labels.grid.indexToWorld * (voxel + offset).cast<double>();
      greatest = std::max(greatest, evalMask(smooth, at));
    }
    vanished += greatest < 0.5;
  }
  return vanished;
}

TEST(AutomaticSmoothing, VesselsOneVoxelWideRemain) {
  for (const auto& [voxel, native] : {std::pair(1.0, 1.0), std::pair(0.9355, 1.5)}) {
    const Vec3 along = Vec3(0.3, 0.2, 1.0).normalized();
    const Segmentation labels = makePart(voxel, native, [&, edge = native](const Vec3& p) {
      const Vec3 away = p - Vec3(-12.0, 0.0, 0.0);
      return (away - away.dot(along) * along).norm() < 0.65 * edge ||
             (p - Vec3(13.0, 0.0, 0.0)).norm() < 12.0;
    });
    const Mask smooth = smoothLabels(labels);
    EXPECT_EQ(countVanished(labels.makeMask(labels.segments(), labels.grid(), {}), smooth), 0);
    EXPECT_LT(std::abs(smooth.volumeChange), 0.003);
  }
}

/// A vessel that leaves the volume remains as far as the mask, whatever is at the opposite face.
TEST(AutomaticSmoothing, VesselsRemainAtFacesOfTheMask) {
  for (const int axis : {0, 1}) {
    const Mask labels = makeMask(makeCube(54.0, Vec3::Ones()), [&](const Vec3& p) {
      const bool isLine = std::abs(p[1 - axis] - 0.5) < 0.1 && std::abs(p.z() - 0.5) < 0.1;
      return (isLine && p[axis] < 0.0) || p[axis] > 15.0;
    });
    const Mask smooth = smoothMaskAuto(labels, 1.5, labels.grid);
    for (std::int64_t i = 0; i < 20; ++i) {
      Vec3 at = Vec3::Constant(0.5);
      at[axis] = (smooth.grid.indexToWorld * Size3(i, i, i).cast<double>())[axis];
      EXPECT_GE(evalMask(smooth, at), 0.5) << axis << ' ' << i;
    }
  }
}

TEST(AutomaticSmoothing, VesselsKeepTheirWidth) {
  const Vec3 along = Vec3(0.3, 0.2, 1.0).normalized(), organ(13.0, 0.0, 0.0);
  for (const auto& [voxel, native] : {std::pair(1.0, 1.0), std::pair(0.9355, 1.5)})
    for (const double width : {2.0, 3.0, 4.0, 5.0}) { // native voxels
      const auto findCenter = [&](double z) {
        return Vec3(-12.0, 0.0, 0.0) + z / along.z() * along;
      };
      const Segmentation labels = makePart(voxel, native, [&, edge = native](const Vec3& p) {
        const Vec3 away = p - findCenter(0.0);
        return (away - away.dot(along) * along).norm() < 0.5 * width * edge ||
               (p - organ).norm() < 12.0;
      });
      const Mask plain = labels.makeMask(labels.segments(), labels.grid(), {});
      const Mask smooth = smoothLabels(labels);
      double sum = 0.0, sumBefore = 0.0;
      for (double z = -15.0; z < 15.0; z += 0.37)
        for (const Vec3& across : {Vec3(0.0, 8.0, 0.0), Vec3(8.0, 0.0, 0.0)}) {
          const Vec3 center = findCenter(z);
          sum += measureInside(smooth, center - across, center + across);
          sumBefore += measureInside(plain, center - across, center + across);
        }
      EXPECT_NEAR(sum / sumBefore, 1.0, 0.15) << width;
    }
}

} // namespace
} // namespace fenestra::core::AutomaticSmoothingTests
