#include "model/filtering/ScannerTable.h"

#include "base/Distribution.h"
#include "model/filtering/TableSheets.h"
#include "model/masks/Rows.h"

#include <tbb/parallel_for.h>

#include <array>
#include <cmath>
#include <numeric>

namespace fenestra::core {
namespace {

constexpr std::int64_t unknownRow = -1;

std::optional<PatientAxes> findAxes(const Grid& grid) {
  const double least = std::cos(20.0 / 180.0 * pi);
  std::array<int, 3> axes{};
  for (int patient = 0; patient < 3; ++patient) {
    int& axis = axes[static_cast<std::size_t>(patient)];
    axis = -1;
    for (int own = 0; own < 3; ++own)
      if (std::abs(grid.indexToWorld.linear().col(own).normalized()[patient]) >= least)
        axis = own;
    if (axis < 0)
      return std::nullopt;
  }
  return PatientAxes{axes[0], axes[1], axes[2]};
}

/// Voxels above the level, in patient axes.
SolidVoxels findSolid(const Volume& ct, const PatientAxes& axes, bool isDownPositive) {
  const Size3& size = ct.grid.size;
  const Vec3 spacing = ct.grid.spacing();
  SolidVoxels solid;
  solid.size = {size[axes.across], size[axes.down], size[axes.along]};
  solid.spacing = {spacing[axes.across], spacing[axes.down], spacing[axes.along]};
  solid.marks.resize(static_cast<std::size_t>(size.prod()));
  const std::array<std::int64_t, 3> strides = {1, size.x(), size.x() * size.y()};
  const auto stride = [&](int axis) { return strides[static_cast<std::size_t>(axis)]; };
  const auto fill = [&](const auto& voxels) {
    forEachRow(solid.size, [&](std::int64_t row, std::int64_t slice, std::size_t to) {
      const std::int64_t down = isDownPositive ? row : solid.size.y() - 1 - row;
      std::int64_t from = down * stride(axes.down) + slice * stride(axes.along);
      for (std::int64_t x = 0; x < solid.size.x(); ++x, from += stride(axes.across))
        solid.marks[to++] =
            static_cast<double>(voxels[static_cast<std::size_t>(from)]) > SolidVoxels::level;
    });
  };
  std::visit(fill, ct.voxels);
  return solid;
}

/// Rows of a sheet's top at full resolution.
class TableTop {
public:
  TableTop(const SolidVoxels& solid, const Sheet& sheet) : m_solid(solid), m_sheet(sheet) {
    measureRows();
    fitContact();
  }

  ScannerTable table() && { return {{}, true, std::move(m_tops), std::move(m_offsets)}; }

private:
  /// First row of the sheet; unknownRow: none, or it may be the patient's.
  std::int64_t findTop(std::int64_t column, std::int64_t slice) const {
    const auto reach = static_cast<std::int64_t>(greatestSag / m_solid.spacing.y());
    const std::int64_t usual = m_sheet.row(column);
    if (usual == unknownRow || !m_sheet.isFree(column, slice))
      return unknownRow;
    std::int64_t row = usual;
    while (row < std::min(usual + reach, m_solid.size.y() - 1) && !m_solid.at(column, row, slice))
      ++row;
    while (row > std::max<std::int64_t>(0, usual - reach) && m_solid.at(column, row - 1, slice))
      --row;
    return m_solid.at(column, row, slice) && row > usual - reach ? row : unknownRow;
  }

  std::int64_t measureThickness(std::int64_t column, std::int64_t row, std::int64_t slice) const {
    std::int64_t end = row;
    while (end < m_solid.size.y() && m_solid.at(column, end, slice))
      ++end;
    return end - row;
  }

  /// Medians of the columns over slices, and of the slices' offsets over columns.
  void measureRows() {
    const Size3& size = m_solid.size;
    m_tops.assign(static_cast<std::size_t>(size.x()), unknownRow);
    std::vector<std::vector<std::int64_t>> bySlice(static_cast<std::size_t>(size.z()));
    for (std::int64_t x = 0; x < size.x(); ++x) {
      std::vector<std::int64_t> rows, places;
      for (std::int64_t z = 0; z < size.z(); ++z)
        if (const std::int64_t row = findTop(x, z); row != unknownRow) {
          rows.push_back(row);
          places.push_back(z);
        }
      if (rows.empty())
        continue;
      const std::int64_t top = m_tops[static_cast<std::size_t>(x)] = findMedian(std::vector(rows));
      for (std::size_t i = 0; i < rows.size(); ++i) {
        bySlice[static_cast<std::size_t>(places[i])].push_back(rows[i] - top);
        m_thicknesses.push_back(measureThickness(x, rows[i], places[i]));
      }
    }
    for (std::vector<std::int64_t>& offsets : bySlice)
      m_offsets.push_back(offsets.empty() ? 0 : findMedian(offsets));
  }

  /// Tops of the columns in which the patient lies on the sheet.
  void fitContact() {
    std::vector<std::pair<double, double>> points;
    for (std::size_t x = 0; x < m_tops.size(); ++x)
      if (m_tops[x] != unknownRow && m_sheet.isOnParabola(static_cast<std::int64_t>(x)))
        points.emplace_back(static_cast<double>(x), static_cast<double>(m_tops[x]));
    const std::optional<Parabola> parabola = Parabola::fit(points);
    double squares = 0.0;
    if (parabola)
      for (const auto& [x, row] : points)
        squares += std::pow(row - parabola->at(x), 2) / static_cast<double>(points.size());
    if (!parabola || !(squares <= 1.0))
      return;
    std::vector<std::size_t> contact;
    for (std::size_t x = 0; x < m_tops.size(); ++x)
      if (m_tops[x] == unknownRow && m_sheet.isBetweenPieces(static_cast<std::int64_t>(x))) {
        contact.push_back(x);
        m_tops[x] = std::llround(parabola->at(static_cast<double>(x)));
      }
    if (!isSheetParallel(contact)) // below the sheet is nothing of the patient
      for (const std::size_t x : contact)
        m_tops[x] += std::llround(thickestSheet / m_solid.spacing.y());
  }

  /// True if the sheet has the same thickness under the patient as beside.
  bool isSheetParallel(const std::vector<std::size_t>& contact) {
    constexpr double leastEqual = 0.9;
    const std::int64_t usual = findMedian(m_thicknesses);
    const auto tolerance = std::max<std::int64_t>(1, std::llround(1.0 / m_solid.spacing.y()));
    double all = 0.0, equal = 0.0;
    for (const std::size_t x : contact)
      for (std::int64_t z = 0; z < m_solid.size.z(); ++z) {
        const auto column = static_cast<std::int64_t>(x);
        if (m_sheet.isFree(column, z))
          continue;
        const std::int64_t row = m_tops[x] + m_offsets[static_cast<std::size_t>(z)];
        all += 1.0;
        equal += row >= 0 && std::abs(measureThickness(column, row, z) - usual) <= tolerance;
      }
    return equal >= leastEqual * all;
  }

  const SolidVoxels& m_solid;
  const Sheet& m_sheet;
  std::vector<std::int64_t> m_tops, m_offsets, m_thicknesses;
};

} // namespace

std::optional<ScannerTable> findScannerTable(const Volume& ct) {
  constexpr double leastLength = 30.0; // mm
  const std::optional<PatientAxes> axes = findAxes(ct.grid);
  if (!axes ||
      static_cast<double>(ct.grid.size[axes->along]) * ct.grid.spacing()[axes->along] < leastLength)
    return std::nullopt;
  const bool isPosteriorPositive = ct.grid.indexToWorld.linear().col(axes->down).y() < 0.0;
  for (const bool isDownPositive : {isPosteriorPositive, !isPosteriorPositive}) { // supine, prone
    const SolidVoxels solid = findSolid(ct, *axes, isDownPositive);
    if (!mayHaveSheet(solid))
      return std::nullopt;
    if (const std::optional<Sheet> sheet = findSheet(solid)) {
      ScannerTable table = TableTop(solid, *sheet).table();
      table.axes = *axes;
      table.isDownPositive = isDownPositive;
      return table;
    }
  }
  return std::nullopt;
}

double removeScannerTable(const ScannerTable& table, const Mask* preserved, Volume& ct) {
  constexpr double air = -1000.0;
  constexpr std::int64_t halo = 2; // voxels of partial volume
  const PatientAxes& axes = table.axes;
  const Size3& size = ct.grid.size;
  const std::int64_t rows = size[axes.down];
  const Affine toMask =
      preserved ? preserved->grid.worldToIndex * ct.grid.indexToWorld : Affine::Identity();
  const auto isPreserved = [&](const Size3& voxel) {
    const Vec3 at = toMask * voxel.cast<double>();
    return preserved && preserved->contains(at.array().round().cast<std::int64_t>());
  };
  std::vector<std::int64_t> removed(table.offsets.size());
  const auto remove = [&](auto& voxels) {
    using Value = typename std::remove_cvref_t<decltype(voxels)>::value_type;
    const auto emptied = static_cast<Value>(std::max(air, ct.minimum));
    const auto isSolid = [&](const Size3& voxel) {
      return static_cast<double>(voxels[linearIndex(voxel, size)]) > SolidVoxels::level;
    };
    tbb::parallel_for(std::size_t{0}, removed.size(), [&](std::size_t slice) {
      for (std::size_t column = 0; column < table.tops.size(); ++column) {
        if (table.tops[column] < 0)
          continue;
        const auto locate = [&](std::int64_t row) {
          Size3 voxel;
          voxel[axes.along] = static_cast<std::int64_t>(slice);
          voxel[axes.across] = static_cast<std::int64_t>(column);
          voxel[axes.down] = table.isDownPositive ? row : rows - 1 - row;
          return voxel;
        };
        std::int64_t top = table.tops[column] + table.offsets[slice];
        if (top >= 2 && top <= rows && isSolid(locate(top - 1)) && !isSolid(locate(top - 2)))
          --top; // of the sheet, with air above it
        for (std::int64_t row = std::max<std::int64_t>(0, top - halo); row < rows; ++row) {
          const Size3 voxel = locate(row);
          const bool wasSolid = isSolid(voxel);
          if ((row < top && wasSolid) || isPreserved(voxel))
            continue;
          removed[slice] += wasSolid;
          Value& value = voxels[linearIndex(voxel, size)];
          value = std::min(value, emptied);
        }
      }
    });
  };
  std::visit(remove, ct.voxels);
  computeRange(ct);
  return static_cast<double>(std::accumulate(removed.begin(), removed.end(), std::int64_t{0})) *
         std::abs(ct.grid.indexToWorld.linear().determinant());
}

} // namespace fenestra::core
