#pragma once
// The continuous field between a volume's voxels, and its gradient.

#include "base/ScalarMath.h"
#include "model/volume/Volume.h"

namespace fenestra::core::scalar {
#include "formulas/Interpolation.inl"
} // namespace fenestra::core::scalar

namespace fenestra::core {

/// The continuous field of `Volume::voxels`: trilinear between voxel centers, clamped in the outer
/// half voxel. Points are in index space, in Grid::indexBox(). The voxels must outlive the field.
template <typename Voxel>
class Field {
public:
  Field(const Grid& grid, std::span<const Voxel> voxels)
      : m_voxels(voxels.data()),
        m_last(grid.size.array() - 1),
        m_stride(1, grid.size.x(), grid.size.x() * grid.size.y()),
        m_indexGradientToWorld(grid.worldToIndex.linear().transpose()) {}

  double value(const Vec3& index) const {
    const scalar::AxisPosition x = locate(index, 0), y = locate(index, 1), z = locate(index, 2);
    const Voxel* const first = m_voxels + offset(0, x.lower) + offset(1, y.lower);
    const std::int64_t right = offset(0, x.lower + 1.0) - offset(0, x.lower);
    const std::int64_t up = offset(1, y.lower + 1.0) - offset(1, y.lower);
    const auto slice = [&](double lower) {
      const Voxel* const v = first + offset(2, lower);
      const auto at = [v](std::int64_t step) { return static_cast<double>(v[step]); };
      return scalar::interpolate(at(0), at(right), at(up), at(up + right), x.fraction, y.fraction);
    };
    return scalar::lerp(slice(z.lower), slice(z.lower + 1.0), z.fraction);
  }

  /// Gradient in scalar units per mm, world axes: central differences over one voxel on each side.
  Vec3 gradient(const Vec3& index) const {
    Vec3 difference;
    for (int axis = 0; axis < 3; ++axis) {
      const Vec3 step = Vec3::Unit(axis);
      difference[axis] = 0.5 * (value(index + step) - value(index - step));
    }
    return m_indexGradientToWorld * difference;
  }

  /// Gradient in the same units by the 3x3x3 kernel of Sobel (Sobel and Feldman 1968): central
  /// differences at the voxels, smoothed by (1, 2, 1) / 4 along both other axes, where voxels of
  /// the border repeat; trilinear between voxel centers. It has less noise than gradient(), and
  /// less of a grid's pattern on smooth surfaces.
  Vec3 sobelGradient(const Vec3& index) const {
    const SobelAxis x = locateSobel(index, 0), y = locateSobel(index, 1), z = locateSobel(index, 2);
    scalar::Float4 alongX, alongY, means; // of the four slices
    for (std::size_t k = 0; k < 4; ++k) {
      scalar::Float4 rowsAlongX, rowMeans;
      for (std::size_t j = 0; j < 4; ++j) {
        const Voxel* const row = m_voxels + z.offsets[k] + y.offsets[j];
        scalar::Float4 values;
        for (std::size_t i = 0; i < 4; ++i)
          values[i] = static_cast<double>(row[x.offsets[i]]);
        rowsAlongX[j] = evalRise(x.weights, values);
        rowMeans[j] = evalMean(x.weights, values);
      }
      alongX[k] = evalMean(y.weights, rowsAlongX);
      alongY[k] = evalRise(y.weights, rowMeans);
      means[k] = evalMean(y.weights, rowMeans);
    }
    const Vec3 difference(evalMean(z.weights, alongX), evalMean(z.weights, alongY),
                          evalRise(z.weights, means));
    return m_indexGradientToWorld * (0.5 * difference);
  }

private:
  struct SobelAxis {
    scalar::SobelAxis weights;
    std::array<std::int64_t, 4> offsets; ///< of the four voxels
  };

  double last(int axis) const { return static_cast<double>(m_last[axis]); }
  double lastCell(int axis) const { return std::max(0.0, last(axis) - 1.0); }
  scalar::AxisPosition locate(const Vec3& index, int axis) const {
    return scalar::locateOnAxis(last(axis), lastCell(axis), index[axis]);
  }
  SobelAxis locateSobel(const Vec3& index, int axis) const {
    SobelAxis located{scalar::makeSobelAxis(last(axis), lastCell(axis), index[axis]), {}};
    for (std::size_t i = 0; i < 4; ++i)
      located.offsets[i] = offset(axis, located.weights.first + static_cast<double>(i));
    return located;
  }
  /// Offset of a voxel along an axis; the last voxel repeats.
  std::int64_t offset(int axis, double voxel) const {
    return std::min(static_cast<std::int64_t>(voxel), m_last[axis]) * m_stride[axis];
  }

  const Voxel* m_voxels;
  Size3 m_last;   ///< index of the last voxel
  Size3 m_stride; ///< offset of the next voxel
  Mat3 m_indexGradientToWorld;
};

template <typename Voxels>
Field(const Grid&, const Voxels&) -> Field<typename Voxels::value_type>;

} // namespace fenestra::core
