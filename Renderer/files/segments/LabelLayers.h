#pragma once
// Distributes segments that may overlap to the layers of a label map.

#include "files/segments/NativeGrid.h"
#include "model/masks/Voxelize.h"

#include <span>
#include <string>
#include <vector>

namespace fenestra::core {

class LabelLayers {
public:
  using Label = std::int16_t;

  static constexpr std::int64_t mostLabels = std::int64_t{1} << 31;

  /// For a label map of `size` voxels, with at most `maxLabels` labels in all layers; `source` is
  /// the file name in messages.
  LabelLayers(const Size3& size, std::string source, std::int64_t maxLabels = mostLabels)
      : m_size(size), m_maxLabels(maxLabels), m_source(std::move(source)) {}

  std::size_t count() const { return m_count; }

  /// Adds a segment to the first layer in which it overlaps no other; returns that layer. Throws
  /// Error (input) if all layers together exceed the limit.
  std::size_t add(const std::vector<VoxelRun>& runs, Label label);

  /// Moves the labels out, with a voxel's layers adjacent.
  Labels takeInterleaved();

private:
  std::span<Label> voxels(std::size_t layer, const VoxelRun& run);
  bool isFree(std::size_t layer, const std::vector<VoxelRun>& runs);

  Size3 m_size;
  std::int64_t m_maxLabels;
  std::string m_source;
  std::size_t m_count = 0;
  LargeArray<Label> m_labels; ///< layer after layer
};

} // namespace fenestra::core
