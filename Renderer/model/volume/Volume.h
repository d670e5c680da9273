#pragma once
// The scalar volume: voxels in their storage type, and the continuous field interpolated from them.
// Voxels are never converted: code that reads them is a template on their type, and
// integrator/render/Render.h dispatches on it once.

#include "base/Error.h"
#include "base/LargePages.h"
#include "model/volume/Grid.h"

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

namespace fenestra::core {

/// Kind of scan. CT scalars are Hounsfield units, those of PET standardized uptake values (SUV,
/// g/ml) if the file allows it; MR and ultrasound have no standard unit.
enum class Modality { ct, mr, us, pt };

/// Storage types, x fastest. Readers convert every file type to the smallest of these that holds
/// all its values (64-bit and double values that do not fit are rounded to float).
using Voxels = std::variant<LargeArray<std::uint8_t>, LargeArray<std::int16_t>,
                            LargeArray<std::uint16_t>, LargeArray<float>>;

/// Every voxel is finite: readers replace NaN and -infinity by the volume's smallest finite value,
/// and +infinity by its largest, and add a warning.
struct Volume {
  Grid grid;
  Voxels voxels;
  double minimum = 0.0; ///< smallest voxel value
  double maximum = 0.0;
  std::string name; ///< file name, for messages
  std::vector<Message> warnings;
  std::optional<Modality> modality = {}; ///< stated by the file; empty: not stated, or another one
  bool hasContrastAgent = false;         ///< the file states a contrast agent
  std::size_t frameCount = 1;            ///< of the input; the volume is one of them
};

/// Computes minimum and maximum from the voxels.
inline void computeRange(Volume& volume) {
  const auto compute = [&volume](const auto& voxels) {
    if (voxels.empty())
      return;
    const auto [low, high] = std::ranges::minmax(voxels);
    volume.minimum = static_cast<double>(low);
    volume.maximum = static_cast<double>(high);
  };
  std::visit(compute, volume.voxels);
}

/// The continuous field of `Volume::voxels`: trilinear between voxel centers, clamped in the outer
/// half voxel. Points are in index space, in Grid::indexBox(). The voxels must outlive the field.
template <typename Voxel>
class Field {
public:
  Field(const Grid& grid, std::span<const Voxel> voxels)
      : m_voxels(voxels.data()),
        m_last((grid.size.array() - 1).cast<double>()),
        m_lastCell((grid.size.array() - 2).max(0)),
        m_stride(grid.size.x() > 1 ? 1 : 0, grid.size.y() > 1 ? grid.size.x() : 0,
                 grid.size.z() > 1 ? grid.size.x() * grid.size.y() : 0),
        m_row(grid.size.x()),
        m_slice(grid.size.x() * grid.size.y()),
        m_indexGradientToWorld(grid.worldToIndex.linear().transpose()) {}

  double value(const Vec3& index) const {
    const auto [ix, fx] = cell(index, 0);
    const auto [iy, fy] = cell(index, 1);
    const auto [iz, fz] = cell(index, 2);
    const Voxel* v = m_voxels + ix + iy * m_row + iz * m_slice;
    const double low = bilinear(v, fx, fy);
    const double high = bilinear(v + m_stride[2], fx, fy);
    return low + (high - low) * fz;
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
    std::array<double, 4> alongX, alongY, smooth; // of the four slices
    for (std::size_t k = 0; k < 4; ++k) {
      std::array<double, 4> rowsAlongX, smoothRows;
      for (std::size_t j = 0; j < 4; ++j) {
        const Voxel* row = m_voxels + z.offsets[k] + y.offsets[j];
        std::array<double, 4> voxels;
        for (std::size_t i = 0; i < 4; ++i)
          voxels[i] = static_cast<double>(row[x.offsets[i]]);
        rowsAlongX[j] = x.difference(voxels);
        smoothRows[j] = x.smooth(voxels);
      }
      alongX[k] = y.smooth(rowsAlongX);
      alongY[k] = y.difference(smoothRows);
      smooth[k] = y.smooth(smoothRows);
    }
    return m_indexGradientToWorld * Vec3(z.smooth(alongX), z.smooth(alongY), z.difference(smooth));
  }

private:
  struct Cell {
    std::int64_t index;
    double fraction;
  };

  /// Sobel's kernel along one axis, interpolated between a cell's voxels; of the values at these
  /// voxels and their neighbors.
  struct SobelAxis {
    std::array<std::int64_t, 4> offsets; ///< of the four voxels
    double fraction;

    double smooth(const std::array<double, 4>& v) const {
      const double f = fraction;
      return 0.25 * ((1.0 - f) * v[0] + (2.0 - f) * v[1] + (1.0 + f) * v[2] + f * v[3]);
    }
    /// Per voxel. Exactly 0 if all values are equal.
    double difference(const std::array<double, 4>& v) const {
      return 0.5 * ((1.0 - fraction) * (v[2] - v[0]) + fraction * (v[3] - v[1]));
    }
  };

  SobelAxis locateSobel(const Vec3& index, int axis) const {
    const std::array<std::int64_t, 3> strides = {1, m_row, m_slice};
    const auto [lower, fraction] = cell(index, axis);
    SobelAxis located{{}, fraction};
    for (std::int64_t i = 0; i < 4; ++i) {
      const auto last = static_cast<std::int64_t>(m_last[axis]);
      located.offsets[static_cast<std::size_t>(i)] =
          std::clamp<std::int64_t>(lower + i - 1, 0, last) *
          strides[static_cast<std::size_t>(axis)];
    }
    return located;
  }

  Cell cell(const Vec3& index, int axis) const {
    const double x = std::clamp(index[axis], 0.0, m_last[axis]);
    const auto i = std::min(static_cast<std::int64_t>(x), m_lastCell[axis]);
    return {i, x - static_cast<double>(i)};
  }

  double bilinear(const Voxel* v, double fx, double fy) const {
    const auto lerp = [](double a, double b, double f) { return a + (b - a) * f; };
    const double near = lerp(static_cast<double>(v[0]), static_cast<double>(v[m_stride[0]]), fx);
    v += m_stride[1];
    const double far = lerp(static_cast<double>(v[0]), static_cast<double>(v[m_stride[0]]), fx);
    return lerp(near, far, fy);
  }

  const Voxel* m_voxels;
  Vec3 m_last;
  Size3 m_lastCell;
  Size3 m_stride; ///< offset of the next voxel in each axis; 0 if the axis has one voxel
  std::int64_t m_row, m_slice;
  Mat3 m_indexGradientToWorld;
};

template <typename Voxels>
Field(const Grid&, const Voxels&) -> Field<typename Voxels::value_type>;

} // namespace fenestra::core
