#include "scene/FocusInterface.h"

#include "base/Distribution.h"
#include "model/volume/Field.h"

#include <algorithm>
#include <map>
#include <optional>

namespace fenestra::core {
namespace {

constexpr std::int64_t shellDepth = 3; ///< voxels on either side of a face

/// Keeps every n-th of the values added. n is a power of two, so that about ten thousand remain.
class Subsample {
public:
  void add(double value) {
    if (m_count++ % m_stride != 0)
      return;
    m_values.push_back(value);
    if (m_values.size() < maxValues)
      return;
    for (std::size_t i = 0; 2 * i < m_values.size(); ++i)
      m_values[i] = m_values[2 * i];
    m_values.resize(m_values.size() / 2);
    m_stride *= 2;
  }
  const std::vector<double>& values() const { return m_values; }
  double median() const {
    std::vector<double> values = m_values;
    return findMedian(values);
  }

private:
  static constexpr std::size_t maxValues = 1 << 15;

  std::vector<double> m_values;
  std::size_t m_count = 0, m_stride = 1;
};

/// Visits the faces between focus voxels and other voxels, and samples the volume there.
template <typename Voxel>
class InterfaceSampler {
public:
  InterfaceSampler(const Mask& focus, const Volume& volume, const LargeArray<Voxel>& voxels,
                   const TransferFunction& transfer)
      : m_focus(focus),
        m_field(volume.grid, voxels),
        m_box(volume.grid.indexBox()),
        m_toVolume(volume.grid.worldToIndex * focus.grid.indexToWorld),
        m_transfer(transfer) {}

  /// Calls visit(focus voxel, step to its neighbor) for each face. Rows are skipped so that at most
  /// about `maxVoxels` voxels of the mask are tested.
  template <typename Visit>
  void forEachFace(const Visit& visit) const {
    constexpr double maxVoxels = 4e6;
    const Size3& size = m_focus.grid.size;
    const double surplus = static_cast<double>(m_focus.voxels.size()) / maxVoxels;
    const auto stride = static_cast<std::int64_t>(std::ceil(std::sqrt(std::max(1.0, surplus))));
    for (std::int64_t z = 0; z < size.z(); z += stride)
      for (std::int64_t y = 0; y < size.y(); y += stride)
        for (std::int64_t x = 0; x < size.x(); ++x)
          if (isInside({x, y, z}))
            visitFaces({x, y, z}, visit);
  }

  /// Calls take(voxel, scalar) for the visible voxels of the shell, from `first` to the last voxel
  /// on the same side.
  template <typename Take>
  void forEachShellVoxel(const Size3& first, const Size3& step, const Take& take) const {
    const bool side = isInside(first);
    for (std::int64_t k = 0; k < shellDepth && isInside(first + k * step) == side; ++k)
      if (const auto scalar = visibleScalar(first + k * step))
        take(Size3(first + k * step), *scalar);
  }

private:
  bool isInside(const Size3& voxel) const {
    for (int axis = 0; axis < 3; ++axis)
      if (voxel[axis] < 0 || voxel[axis] >= m_focus.grid.size[axis])
        return false;
    return m_focus.voxels[linearIndex(voxel, m_focus.grid.size)] >= m_focus.threshold();
  }

  template <typename Visit>
  void visitFaces(const Size3& voxel, const Visit& visit) const {
    for (int axis = 0; axis < 3; ++axis)
      for (const std::int64_t sign : {-1, 1}) {
        Size3 step = Size3::Zero();
        step[axis] = sign;
        if (!isInside(voxel + step))
          visit(voxel, step);
      }
  }

  /// Scalar of a voxel; empty if it is transparent or outside the volume.
  std::optional<double> visibleScalar(const Size3& voxel) const {
    const Vec3 index = m_toVolume * voxel.cast<double>();
    if (index != Vec3(index.cwiseMax(m_box.lower).cwiseMin(m_box.upper)))
      return std::nullopt;
    const double value = m_field.value(index);
    return m_transfer.extinction(value)[0] > 0.0 ? std::optional(value) : std::nullopt;
  }

  const Mask& m_focus;
  Field<Voxel> m_field;
  Box m_box;
  Affine m_toVolume;
  const TransferFunction& m_transfer;
};

/// Looks up the components of mask voxels.
class Components {
public:
  Components(const Grid& mask, const LabelWeights& weights, const std::vector<bool>& isFocus)
      : m_weights(weights),
        m_toWeights(weights.grid().worldToIndex * mask.indexToWorld),
        m_isFocus(isFocus) {}

  /// Component with the largest label weight among those of a side; empty if all are 0.
  std::optional<std::uint8_t> at(const Size3& voxel, bool focusSide) const {
    std::optional<std::uint8_t> greatest;
    double maxWeight = 0.0;
    m_weights.forEachWeight(m_toWeights * voxel.cast<double>(),
                            [&](std::uint8_t component, double weight) {
                              if (m_isFocus[component] == focusSide && weight > maxWeight) {
                                greatest = component;
                                maxWeight = weight;
                              }
                            });
    return greatest;
  }

private:
  const LabelWeights& m_weights;
  Affine m_toWeights;
  const std::vector<bool>& m_isFocus;
};

/// Visible scalars on one side of a face, of the component nearest to the face only.
struct Side {
  std::optional<std::uint8_t> component = {};
  std::vector<double> scalars = {};
};

/// Accumulated values of one part of the interface.
struct Part {
  double area = 0.0;
  Subsample focus, context;
};

template <typename Voxel>
std::vector<ComponentInterface> collectInterfaces(const InterfaceSampler<Voxel>& sampler,
                                                  const Grid& mask, const Components& components) {
  const auto collectSide = [&](const Size3& first, const Size3& step, bool focusSide) {
    Side side;
    sampler.forEachShellVoxel(first, step, [&](const Size3& voxel, double scalar) {
      const auto component = components.at(voxel, focusSide);
      if (side.scalars.empty())
        side.component = component;
      if (component && component == side.component)
        side.scalars.push_back(scalar);
    });
    return side;
  };
  std::map<std::pair<std::uint8_t, std::uint8_t>, Part> parts;
  sampler.forEachFace([&](const Size3& voxel, const Size3& step) {
    const Side focus = collectSide(voxel, -step, true),
               context = collectSide(voxel + step, step, false);
    if (!focus.component || !context.component)
      return;
    Part& part = parts[{*focus.component, *context.component}];
    const Mat3 spacing = mask.indexToWorld.linear();
    const Vec3 across = spacing * step.cast<double>();
    part.area += std::abs(spacing.determinant()) / across.norm();
    std::ranges::for_each(focus.scalars, [&](double scalar) { part.focus.add(scalar); });
    std::ranges::for_each(context.scalars, [&](double scalar) { part.context.add(scalar); });
  });
  std::vector<ComponentInterface> interfaces;
  for (const auto& [sides, part] : parts)
    interfaces.push_back(
        {sides.first, sides.second, part.area, part.focus.median(), part.context.median()});
  std::ranges::stable_sort(interfaces, std::greater{}, &ComponentInterface::area);
  return interfaces;
}

} // namespace

InterfaceScalars sampleInterface(const Mask& focus, const Volume& volume,
                                 const TransferFunction& transfer) {
  Subsample inner, outer;
  const auto addTo = [](Subsample& side) {
    return [&side](const Size3&, double scalar) { side.add(scalar); };
  };
  std::visit(
      [&](const auto& voxels) {
        const InterfaceSampler sampler(focus, volume, voxels, transfer);
        sampler.forEachFace([&](const Size3& voxel, const Size3& step) {
          sampler.forEachShellVoxel(voxel, -step, addTo(inner));
          sampler.forEachShellVoxel(voxel + step, step, addTo(outer));
        });
      },
      volume.voxels);
  return {inner.values(), outer.values()};
}

std::vector<ComponentInterface> findInterfaces(const Mask& focus, const Volume& volume,
                                               const TransferFunction& transfer,
                                               const LabelWeights& weights,
                                               const std::vector<bool>& isFocus) {
  const Components components(focus.grid, weights, isFocus);
  return std::visit(
      [&](const auto& voxels) {
        return collectInterfaces(InterfaceSampler(focus, volume, voxels, transfer), focus.grid,
                                 components);
      },
      volume.voxels);
}

} // namespace fenestra::core
