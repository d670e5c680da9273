#include "model/masks/MaskShaping.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>

namespace fenestra::core {
namespace {

/// Axis along which voxels are longest, and the number of slices that replace one. It is odd: then
/// no new slice lies halfway between two outlines, where inside and outside would be undecided.
struct Subdivision {
  int axis;
  std::int64_t parts;
};

Subdivision computeSubdivision(const Grid& grid) {
  constexpr double most = 9.0; // limits memory; more slices would add no information
  const Vec3 edges = grid.spacing();
  const int axis = static_cast<int>(std::max_element(edges.begin(), edges.end()) - edges.begin());
  const double widest = std::max(edges[axis == 0 ? 1 : 0], edges[axis == 2 ? 1 : 2]);
  const double ratio = edges[axis] / widest * (1.0 + 1e-6); // rounding
  return {axis, 2 * static_cast<std::int64_t>(std::min(ratio, most) / 2.0) + 1};
}

/// Slices of a mask across the axis along which its voxels are longest; lengths in mm.
class Slices {
public:
  explicit Slices(const Mask& mask) : m_mask(mask) {
    const Vec3 spacing = mask.grid.spacing();
    m_axis = computeSubdivision(mask.grid).axis;
    m_thickness = spacing[m_axis];
    const int column = m_axis == 0 ? 1 : 0, row = m_axis == 2 ? 1 : 2;
    const Size3& size = mask.grid.size;
    const Size3 steps{1, size.x(), size.x() * size.y()};
    m_count = {size[column], size[row], size[m_axis]};
    m_step = {steps[column], steps[row], steps[m_axis]};
    m_edge = {spacing[column], spacing[row]};
  }

  int axis() const { return m_axis; }
  std::int64_t count() const { return m_count[2]; }

  bool isInside(std::int64_t column, std::int64_t row, std::int64_t slice) const {
    return m_mask.voxels[static_cast<std::size_t>(column * m_step[0] + row * m_step[1] +
                                                  slice * m_step[2])] >= m_mask.threshold();
  }

  /// Buffers of computeDistances(), per pixel.
  struct Workspace {
    std::vector<double> along, toInside, toOutside;
  };

  /// Signed distance of each pixel to the slice's outline, negative inside, limited to
  /// maxDistance(): the distance to the nearest pixel on the other side, minus half a pixel.
  std::vector<float> computeDistances(std::int64_t slice, Workspace& space) const {
    const double half = 0.5 * std::min(m_edge[0], m_edge[1]);
    findSquaredDistances(true, slice, space.along, space.toInside);
    findSquaredDistances(false, slice, space.along, space.toOutside);
    std::vector<float> result(space.toInside.size());
    std::ranges::transform(space.toInside, space.toOutside, result.begin(),
                           [&](double inside, double outside) {
                             return static_cast<float>(inside > 0.0 ? std::sqrt(inside) - half
                                                                    : half - std::sqrt(outside));
                           });
    return result;
  }

private:
  double maxDistance() const { return 2.0 * m_thickness; }

  /// Finds the distances along rows to the nearest pixel that is inside (`inside` false: outside).
  void findRowDistances(bool inside, std::int64_t slice, std::vector<double>& result) const {
    const auto [columns, rows, slices] = m_count;
    result.resize(static_cast<std::size_t>(columns * rows));
    for (std::int64_t row = 0; row < rows; ++row) {
      double* const to = result.data() + columns * row;
      double distance = maxDistance();
      const auto advance = [&](std::int64_t column) {
        return distance = isInside(column, row, slice) == inside ? 0.0 : distance + m_edge[0];
      };
      for (std::int64_t column = 0; column < columns; ++column)
        to[column] = std::min(maxDistance(), advance(column));
      distance = maxDistance();
      for (std::int64_t column = columns; column-- > 0;)
        to[column] = std::min(to[column], advance(column));
    }
  }

  /// True if a pixel of the row is inside.
  bool hasInside(std::int64_t row, std::int64_t slice) const {
    for (std::int64_t column = 0; column < m_count[0]; ++column)
      if (isInside(column, row, slice))
        return true;
    return false;
  }

  /// Finds the squared distances from all pixels to the nearest pixel inside; or, if `inside` is
  /// false, from pixels inside to the nearest one outside. `along`: buffer for distances along
  /// rows.
  void findSquaredDistances(bool inside, std::int64_t slice, std::vector<double>& along,
                            std::vector<double>& result) const {
    const auto [columns, rows, slices] = m_count;
    std::vector<std::uint8_t> hasInsidePixel(static_cast<std::size_t>(rows));
    for (std::int64_t row = 0; row < rows; ++row)
      hasInsidePixel[static_cast<std::size_t>(row)] = hasInside(row, slice);
    findRowDistances(inside, slice, along);
    result.assign(along.size(), maxDistance() * maxDistance());
    const auto rowRange = static_cast<std::int64_t>(maxDistance() / m_edge[1]);
    for (std::int64_t row = 0; row < rows; ++row) {
      if (!inside && !hasInsidePixel[static_cast<std::size_t>(row)])
        continue;
      double* const to = result.data() + columns * row;
      const std::int64_t end = std::min(row + rowRange + 1, rows);
      for (std::int64_t other = std::max<std::int64_t>(row - rowRange, 0); other < end; ++other) {
        if (inside && !hasInsidePixel[static_cast<std::size_t>(other)])
          continue;
        const double across = static_cast<double>(other - row) * m_edge[1];
        const double* const from = along.data() + columns * other;
        std::transform(from, from + columns, to, to, [&](double distance, double least) {
          return std::min(least, distance * distance + across * across);
        });
      }
    }
  }

  const Mask& m_mask;
  int m_axis = 0;
  double m_thickness = 0.0;            ///< distance between slices
  std::array<std::int64_t, 3> m_count; ///< columns, rows, slices
  std::array<std::int64_t, 3> m_step;  ///< to the next column, row, slice, in the mask's voxels
  std::array<double, 2> m_edge;        ///< distances between columns, between rows
};

/// A position between two slices.
struct SlicePair {
  const float *before, *after; ///< signed distances in both slices
  float fraction;              ///< of the distance from one to the other, 0 to 1

  bool isInside(std::int64_t pixel) const {
    return (1.0F - fraction) * before[pixel] + fraction * after[pixel] < 0.0F;
  }
};

/// Grid with steps divided into `parts` along an axis, between the same outermost centers.
Grid subdivideGrid(const Grid& grid, int axis, std::int64_t parts) {
  Size3 size = grid.size;
  size[axis] = (size[axis] - 1) * parts + 1;
  Affine indexToWorld = grid.indexToWorld;
  indexToWorld.linear().col(axis) /= static_cast<double>(parts);
  return {size, indexToWorld};
}

} // namespace

Mask interpolateSlices(Mask mask) {
  const std::int64_t parts = computeSubdivision(mask.grid).parts;
  if (parts == 1)
    return mask;
  const Slices slices(mask);
  std::vector<std::vector<float>> distances(static_cast<std::size_t>(slices.count()));
  tbb::enumerable_thread_specific<Slices::Workspace> workspaces;
  tbb::parallel_for(std::size_t{0}, distances.size(), [&](std::size_t slice) {
    distances[slice] =
        slices.computeDistances(static_cast<std::int64_t>(slice), workspaces.local());
  });
  const int axis = slices.axis();
  Mask result{subdivideGrid(mask.grid, axis, parts), {}, 0, mask.names};
  const Size3& size = result.grid.size;
  result.voxels.resize(static_cast<std::size_t>(result.grid.voxelCount()));
  const auto findPair = [&](std::int64_t at) {
    const auto before = static_cast<std::size_t>(at / parts);
    const std::size_t after = std::min(before + 1, distances.size() - 1);
    const float fraction = static_cast<float>(at % parts) / static_cast<float>(parts);
    return SlicePair{distances[before].data(), distances[after].data(), fraction};
  };
  const std::int64_t columns = axis == 0 ? size.y() : size.x();
  tbb::parallel_for(std::int64_t{0}, size.z(), [&](std::int64_t z) {
    for (std::int64_t y = 0; y < size.y(); ++y) {
      std::uint8_t* const to = result.voxels.data() + linearIndex(Size3(0, y, z), size);
      if (axis == 0) {
        for (std::int64_t x = 0; x < size.x(); ++x)
          to[x] = findPair(x).isInside(y + columns * z);
        continue;
      }
      const SlicePair pair = findPair(axis == 1 ? y : z);
      const std::int64_t first = columns * (axis == 1 ? z : y);
      for (std::int64_t x = 0; x < size.x(); ++x)
        to[x] = pair.isInside(first + x);
    }
  });
  result.count = std::ranges::count(result.voxels, std::uint8_t{1});
  const auto before = parts * std::ranges::count(mask.voxels, std::uint8_t{1});
  result.volumeChange = static_cast<double>(result.count) / static_cast<double>(before) - 1.0;
  return result;
}

} // namespace fenestra::core
