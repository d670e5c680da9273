#include "files/segments/LabelLayers.h"

#include "base/Error.h"
#include "files/segments/SegmentationReader.h"

#include <algorithm>

namespace fenestra::core {

std::size_t LabelLayers::add(const std::vector<VoxelRun>& runs, Label label) {
  std::size_t layer = 0;
  while (layer < m_count && !isFree(layer, runs))
    ++layer;
  if (layer == m_count) {
    std::int64_t labels = 0;
    if (__builtin_mul_overflow(m_size.prod(), static_cast<std::int64_t>(m_count + 1), &labels) ||
        labels > m_maxLabels)
      throw inputError(ErrorCode::limitExceeded, m_source,
                       "has segments that overlap in too many layers; export the segmentation in "
                       "Slicer as a binary labelmap (.seg.nrrd)");
    m_labels.resize(static_cast<std::size_t>(labels));
    ++m_count;
  }
  for (const VoxelRun& run : runs)
    std::ranges::fill(voxels(layer, run), label);
  return layer;
}

Labels LabelLayers::takeInterleaved() {
  return interleaveLayers(std::move(m_labels), m_count);
}

std::span<LabelLayers::Label> LabelLayers::voxels(std::size_t layer, const VoxelRun& run) {
  const std::int64_t z = run.z + m_size.z() * static_cast<std::int64_t>(layer);
  const std::int64_t begin = run.first + m_size.x() * (run.y + m_size.y() * z);
  return std::span(m_labels).subspan(static_cast<std::size_t>(begin),
                                     static_cast<std::size_t>(run.last - run.first));
}

bool LabelLayers::isFree(std::size_t layer, const std::vector<VoxelRun>& runs) {
  return std::ranges::all_of(runs, [&](const VoxelRun& run) {
    return std::ranges::all_of(voxels(layer, run), [](Label label) { return label == 0; });
  });
}

} // namespace fenestra::core
