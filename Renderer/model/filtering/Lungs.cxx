#include "model/filtering/Lungs.h"

#include "base/Distribution.h"
#include "model/masks/Rows.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace fenestra::core {
namespace {

constexpr float highestAir = -400.0F;   // HU; the walls of vessels and of the chest are above it
constexpr double lowestMedian = -950.0; // HU
constexpr double leastVolume = 150e3;   // mm^3
constexpr double closing = 6.0;         // mm

/// Cells of about 1.5 mm with the mean of their voxels.
struct CoarseVolume {
  Grid grid;
  std::vector<float> values;
};

CoarseVolume average(const Volume& ct) {
  constexpr double edge = 1.5; // mm
  const Vec3 spacing = ct.grid.spacing();
  Size3 factor, size;
  for (int axis = 0; axis < 3; ++axis) {
    factor[axis] =
        std::clamp<std::int64_t>(std::llround(edge / spacing[axis]), 1, ct.grid.size[axis]);
    size[axis] = ct.grid.size[axis] / factor[axis];
  }
  const Vec3 scale = factor.cast<double>();
  const Affine toVoxels(Mat3::Diagonal(scale), (scale.array() - 1.0) * 0.5);
  CoarseVolume cells{{size, ct.grid.indexToWorld * toVoxels},
                     std::vector<float>(static_cast<std::size_t>(size.prod()))};
  const auto fill = [&](const auto& voxels) {
    forEachRow(size, [&](std::int64_t y, std::int64_t z, std::size_t to) {
      for (std::int64_t x = 0; x < size.x(); ++x) {
        double sum = 0.0;
        for (std::int64_t k = 0; k < factor.z(); ++k)
          for (std::int64_t j = 0; j < factor.y(); ++j) {
            const std::size_t from =
                linearIndex({x * factor.x(), y * factor.y() + j, z * factor.z() + k}, ct.grid.size);
            for (std::size_t i = 0; i < static_cast<std::size_t>(factor.x()); ++i)
              sum += static_cast<double>(voxels[from + i]);
          }
        cells.values[to++] = static_cast<float>(sum / static_cast<double>(factor.prod()));
      }
    });
  };
  std::visit(fill, ct.voxels);
  return cells;
}

/// Air in cells, taken away by connected parts.
class Air {
public:
  explicit Air(const CoarseVolume& cells) : m_cells(cells), m_isAir(cells.values.size()) {
    std::ranges::transform(cells.values, m_isAir.begin(),
                           [](float value) { return std::uint8_t{value < highestAir}; });
  }

  /// Takes what is connected with the sides, but not with the ends along the patient.
  void takeOutside() {
    const Mat3& axes = m_cells.grid.indexToWorld.linear();
    int along = 0;
    for (int axis = 1; axis < 3; ++axis)
      if (std::abs(axes.col(axis).normalized().z()) > std::abs(axes.col(along).normalized().z()))
        along = axis;
    const Size3& size = m_cells.grid.size;
    for (std::size_t cell = 0; cell < m_isAir.size(); ++cell) {
      const Size3 at = locate(cell);
      for (int axis = 0; axis < 3; ++axis)
        if (m_isAir[cell] && axis != along && (at[axis] == 0 || at[axis] == size[axis] - 1))
          takePart(cell);
    }
  }

  /// Cells of the next part, the first of which is at or after `cell`; empty: no part is left.
  std::vector<std::size_t> takeNext(std::size_t cell) {
    while (cell < m_isAir.size() && !m_isAir[cell])
      ++cell;
    return cell < m_isAir.size() ? takePart(cell) : std::vector<std::size_t>();
  }

private:
  Size3 locate(std::size_t cell) const {
    const auto i = static_cast<std::int64_t>(cell);
    const Size3& size = m_cells.grid.size;
    return {i % size.x(), i / size.x() % size.y(), i / size.x() / size.y()};
  }

  std::vector<std::size_t> takePart(std::size_t first) {
    const Size3& size = m_cells.grid.size;
    std::vector<std::size_t> part = {first};
    m_isAir[first] = 0;
    for (std::size_t next = 0; next < part.size(); ++next) {
      const Size3 from = locate(part[next]);
      for (int axis = 0; axis < 3; ++axis)
        for (const std::int64_t step : {-1, 1}) {
          Size3 to = from;
          to[axis] += step;
          if (to[axis] < 0 || to[axis] >= size[axis])
            continue;
          const std::size_t cell = linearIndex(to, size);
          if (m_isAir[cell])
            part.push_back(cell);
          m_isAir[cell] = 0;
        }
    }
    return part;
  }

  const CoarseVolume& m_cells;
  Marks m_isAir;
};

/// Fills gaps up to twice `closing` wide.
void fillGaps(const Grid& grid, Marks& marks) {
  const auto farther = [&](double limit) {
    const std::vector<float> distances = computeDistances(marks, grid, limit + 1.0);
    Marks far(marks.size());
    std::ranges::transform(distances, far.begin(), [limit](float distance) {
      return std::uint8_t{static_cast<double>(distance) > limit};
    });
    return far;
  };
  marks = farther(closing); // outside of the grown lungs
  marks = farther(closing);
}

} // namespace

std::optional<Lungs> findLungs(const Volume& ct) {
  const CoarseVolume cells = average(ct);
  const double cellVolume = std::abs(cells.grid.indexToWorld.linear().determinant());
  Lungs lungs{cells.grid, Marks(cells.values.size())};
  Air air(cells);
  air.takeOutside();
  for (std::vector<std::size_t> part = air.takeNext(0); !part.empty();
       part = air.takeNext(part.front())) {
    if (static_cast<double>(part.size()) * cellVolume < leastVolume)
      continue;
    std::vector<double> values;
    for (const std::size_t cell : part)
      values.push_back(static_cast<double>(cells.values[cell]));
    if (findMedian(std::move(values)) > lowestMedian)
      for (const std::size_t cell : part)
        lungs.marks[cell] = 1;
  }
  if (std::ranges::find(lungs.marks, 1) == lungs.marks.end())
    return std::nullopt;
  fillGaps(lungs.grid, lungs.marks);
  lungs.volume = static_cast<double>(std::ranges::count(lungs.marks, 1)) * cellVolume;
  return lungs;
}

} // namespace fenestra::core
