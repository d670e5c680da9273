// Tables of scanners under synthetic bodies: what is removed of both.

#include "base/Random.h"
#include "model/filtering/ScannerTable.h"

#include <gtest/gtest.h>

#include <functional>

namespace fenestra::core::ScannerTableTests {
namespace {

/// Coordinates, mm: x right-left, y toward the table, whose top is at y = 0 in the middle, z along.
using Shape = std::function<bool(const Vec3&)>;

/// Ellipse along z with its lowest point at y = `bottom`.
Shape makeEllipse(double x, double bottom, double width, double height) {
  return [=](const Vec3& p) {
    const double u = (p.x() - x) / (0.5 * width),
                 v = (p.y() - bottom + 0.5 * height) / (0.5 * height);
    return u * u + v * v < 1.0;
  };
}

/// Rounded rectangle along z; its lower side is flat.
Shape makeFlatBack(double bottom, double width, double height) {
  return [=](const Vec3& p) {
    const double side = 0.5 * height;
    if (std::abs(p.x()) < 0.5 * width)
      return p.y() < bottom && p.y() > bottom - height;
    const double u = std::abs(p.x()) - 0.5 * width, v = p.y() - bottom + side;
    return u * u + v * v < side * side;
  };
}

/// Varies along the patient, as bodies do.
Shape vary(const Shape& shape) {
  return [=](const Vec3& p) {
    const double scale = 1.0 + 0.08 * std::sin(0.02 * p.z());
    return shape({p.x() * scale, p.y() * scale, p.z()});
  };
}

struct Table {
  double width = 420.0, sheet = 4.0, thickness = 60.0;
  double curvature = 0.0; ///< rise of the edges, mm per mm^2: y = -curvature x^2
  double sag = 0.0;       ///< mm per mm along the patient

  double top(const Vec3& p) const { return sag * p.z() - curvature * p.x() * p.x(); }
  bool isSheet(const Vec3& p) const {
    const double y = p.y() - top(p);
    return std::abs(p.x()) < 0.5 * width &&
           ((y >= 0.0 && y < sheet) || (p.y() > thickness && p.y() < thickness + sheet) ||
            (y >= 0.0 && p.y() < thickness + sheet && std::abs(p.x()) > 0.5 * width - sheet));
  }
  bool isFoam(const Vec3& p) const {
    return std::abs(p.x()) < 0.5 * width && p.y() >= top(p) && p.y() < thickness;
  }
};

struct Scan {
  Volume volume;
  std::vector<std::uint8_t> kind; ///< 1: body, 2: table, 3: other
};

/// The scanner's resolution: (1, 2, 1) / 4 along x and y.
LargeArray<std::int16_t> blur(LargeArray<std::int16_t> voxels, const Size3& size) {
  for (const std::int64_t step : {std::int64_t{1}, size.x()}) {
    const LargeArray<std::int16_t> from = voxels;
    for (std::int64_t i = step; i + step < std::ssize(from); ++i) {
      const auto at = [&](std::int64_t j) { return int{from[static_cast<std::size_t>(j)]}; };
      voxels[static_cast<std::size_t>(i)] =
          static_cast<std::int16_t>((at(i - step) + 2 * at(i) + at(i + step)) / 4);
    }
  }
  return voxels;
}

constexpr std::uint8_t isBody = 1, isTable = 2, isOther = 3;

Scan makeScan(const std::vector<Shape>& bodies, const std::optional<Table>& table,
              const Shape& other = {}, double noise = 20.0) {
  Scan scan;
  const Size3 size(256, 192, 60);
  const Vec3 spacing(1.9, 1.9, 3.0);
  // Index y runs to posterior: LPS axes in RAS.
  scan.volume.grid = Grid(size, Affine(lpsToRas * Mat3::Diagonal(spacing), Vec3::Zero()));
  LargeArray<std::int16_t> voxels;
  Random random(3);
  for (std::int64_t z = 0; z < size.z(); ++z)
    for (std::int64_t y = 0; y < size.y(); ++y)
      for (std::int64_t x = 0; x < size.x(); ++x) {
        const Vec3 p = spacing.cwiseProduct(Vec3(double(x) - 128.0, double(y) - 150.0, double(z)));
        double value = -1000.0;
        std::uint8_t kind = 0;
        if (std::ranges::any_of(bodies, [&](const Shape& body) { return body(p); })) {
          value = 40.0;
          kind = isBody;
        } else if (table && table->isSheet(p)) {
          value = -150.0;
          kind = isTable;
        } else if (table && table->isFoam(p)) {
          value = -930.0;
        } else if (other && other(p)) {
          value = -250.0;
          kind = isOther;
        }
        scan.kind.push_back(kind);
        voxels.push_back(static_cast<std::int16_t>(
            std::lround(value + noise * (random.uniform() + random.uniform() - 1.0))));
      }
  scan.volume.voxels = blur(voxels, size);
  computeRange(scan.volume);
  return scan;
}

struct Removal {
  bool isFound = false;
  double body = 0.0, table = 0.0; ///< fractions of their voxels
};

Removal remove(Scan scan, const Mask* preserved = nullptr) {
  const std::optional<ScannerTable> table = findScannerTable(scan.volume);
  if (!table)
    return {};
  const auto before = std::get<LargeArray<std::int16_t>>(scan.volume.voxels);
  removeScannerTable(*table, preserved, scan.volume);
  const auto& after = std::get<LargeArray<std::int16_t>>(scan.volume.voxels);
  std::array<double, 4> all{}, changed{};
  for (std::size_t i = 0; i < before.size(); ++i) {
    all[scan.kind[i]] += 1.0;
    changed[scan.kind[i]] += before[i] != after[i];
  }
  return {true, changed[isBody] / all[isBody], changed[isTable] / all[isTable]};
}

void expectRemoved(const Scan& scan, const char* name) {
  const Removal removal = remove(scan);
  EXPECT_TRUE(removal.isFound) << name;
  EXPECT_LE(removal.body, 0.001) << name;
  EXPECT_GE(removal.table, 0.95) << name;
}

const Shape trunk = vary(makeEllipse(0.0, -6.0, 320.0, 200.0));
const Shape arm = vary(makeEllipse(205.0, -36.0, 70.0, 80.0));

TEST(ScannerTable, IsRemovedUnderBodies) {
  const Table flat, curved{.curvature = 0.0007}, sagging{.sag = 0.03};
  for (const Table& table : {flat, curved, sagging}) {
    expectRemoved(makeScan({trunk}, table), "trunk");
    expectRemoved(makeScan({trunk, arm}, table), "arm");
    expectRemoved(makeScan({vary(makeEllipse(-60.0, -8.0, 90.0, 110.0)),
                            vary(makeEllipse(60.0, -8.0, 90.0, 110.0))},
                           table),
                  "feet");
  }
}
TEST(ScannerTable, IsRemovedWhereBodiesLieOnIt) {
  const Table flat, curved{.curvature = 0.0007};
  expectRemoved(makeScan({vary(makeEllipse(0.0, 0.0, 320.0, 200.0))}, flat), "touching");
  expectRemoved(makeScan({makeFlatBack(0.0, 160.0, 150.0)}, flat), "flat back");
  const Shape back = makeFlatBack(0.0, 160.0, 150.0);
  expectRemoved(
      makeScan({[&](const Vec3& p) { return back(p - Vec3(0.0, curved.top(p), 0.0)); }}, curved),
      "curved back");
}

TEST(ScannerTable, IsRemovedUnderPillows) {
  const Shape pillow = [](const Vec3& p) {
    const double u = p.x() / 110.0, v = (p.y() + 22.0) / 22.0, r = u * u + v * v;
    return r < 1.0 && r > 0.8 && p.z() > 60.0;
  };
  expectRemoved(makeScan({vary(makeEllipse(0.0, -44.0, 160.0, 190.0))}, Table(), pillow), "pillow");
}

TEST(ScannerTable, NothingIsFoundWithoutOne) {
  EXPECT_FALSE(remove(makeScan({trunk, arm}, {})).isFound);
  EXPECT_FALSE(remove(makeScan({makeFlatBack(0.0, 160.0, 150.0)}, {})).isFound);
  const Shape lungs = [](const Vec3& p) { // walls of 10 mm, as in children
    const Shape inner = makeEllipse(0.0, -20.0, 290.0, 170.0);
    return trunk(p) && !(inner(p) && std::abs(p.x()) > 30.0);
  };
  EXPECT_FALSE(remove(makeScan({lungs}, {})).isFound);
  std::vector<Shape> fingers;
  for (const double x : {-50.0, -25.0, 0.0, 25.0})
    fingers.push_back(makeEllipse(x, 0.0, 15.0, 12.0));
  EXPECT_FALSE(remove(makeScan(fingers, {})).isFound);
}

TEST(ScannerTable, PreservesSegments) {
  const Scan scan = makeScan({trunk}, Table());
  Mask mask;
  mask.grid = scan.volume.grid;
  for (const std::uint8_t kind : scan.kind)
    mask.voxels.push_back(kind == isTable);
  EXPECT_EQ(remove(scan, &mask).table, 0.0);
}

} // namespace
} // namespace fenestra::core::ScannerTableTests
