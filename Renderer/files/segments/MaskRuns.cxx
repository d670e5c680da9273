#include "files/segments/MaskRuns.h"

#include "files/medical/MedicalImage.h"

#include <algorithm>
#include <optional>
#include <type_traits>

namespace fenestra::core {
namespace {

/// Takes the place of a SampleStore: collects runs of samples instead of the samples.
class RunStore {
public:
  explicit RunStore(std::int64_t rowLength) : m_rowLength(rowLength) {}

  template <typename T>
  void append(std::span<const T> block, const SampleStats& s) {
    m_stats.add(s);
    const std::int64_t first = m_position;
    m_position += static_cast<std::int64_t>(block.size());
    if (s.isFinite() && s.minimum == 0.0 && s.maximum == 0.0)
      return;
    for (std::size_t i = 0; i < block.size(); ++i) {
      const T x = block[i];
      if (x == T(0))
        continue;
      const auto value = static_cast<double>(x);
      m_isUniform = m_isUniform && value == m_value.value_or(value);
      m_value = value;
      const std::int64_t voxel = first + static_cast<std::int64_t>(i);
      addVoxel(voxel, m_nonZero);
      if (std::is_floating_point_v<T> && value >= 0.5)
        addVoxel(voxel, m_half);
    }
  }

  /// Runs of the mask; nullopt: the samples are neither a mask nor probabilities.
  std::optional<std::vector<MaskRun>> take() {
    if (!m_stats.isFinite())
      return std::nullopt;
    if (m_isUniform && m_stats.isIntegral)
      return std::move(m_nonZero);
    if (isProbability(m_stats))
      return std::move(m_half);
    return std::nullopt;
  }

private:
  void addVoxel(std::int64_t voxel, std::vector<MaskRun>& runs) const {
    if (!runs.empty() && runs.back().end == voxel && voxel % m_rowLength != 0)
      ++runs.back().end;
    else
      runs.push_back({voxel, voxel + 1});
  }

  std::int64_t m_rowLength, m_position = 0;
  SampleStats m_stats;
  bool m_isUniform = true;
  std::optional<double> m_value; ///< of the last voxel other than 0
  std::vector<MaskRun> m_nonZero, m_half;
};

} // namespace

bool isProbability(const SampleStats& samples) {
  constexpr double rounding = 1e-3; // of resampling
  return samples.isFinite() && !samples.isIntegral && samples.minimum >= -rounding &&
         samples.maximum <= 1.0 + rounding;
}

std::optional<std::vector<MaskRun>> readMaskRuns(const SampleSource& source, std::int64_t width) {
  RunStore store(width);
  readSamples(source, store);
  return store.take();
}

MaskRuns readMask(const std::filesystem::path& path, const VolumeChoice& choice) {
  MaskRuns mask;
  const auto consume = [&](const MedicalImage& image, const SampleSource& source) {
    auto runs = readMaskRuns(source, image.grid.size.x());
    if (!runs)
      throw inputError(ErrorCode::unsupportedFile, path,
                       "is no mask of one structure: it has several values; give a label map "
                       "by itself as the segmentation");
    mask = {image.grid, std::move(*runs), image.warnings};
  };
  readMedicalImage(path, Components::one, consume, choice);
  return mask;
}

std::pair<Grid, Labels> labelMask(const MaskRuns& mask, std::int32_t value) {
  const Size3& size = mask.grid.size;
  const auto findVoxel = [&](std::int64_t index) {
    return Size3(index % size.x(), index / size.x() % size.y(), index / size.x() / size.y());
  };
  Size3 lower = size, upper = Size3::Zero(); // of the voxels, exclusive
  for (const auto& [begin, end] : mask.runs) {
    lower = lower.cwiseMin(findVoxel(begin));
    upper = upper.cwiseMax(findVoxel(end - 1) + Size3::Ones());
  }
  lower = mask.runs.empty() ? Size3(Size3::Zero()) : Size3((lower - Size3::Ones()).cwiseMax(0));
  upper = mask.runs.empty() ? Size3(Size3::Ones()) : Size3((upper + Size3::Ones()).cwiseMin(size));
  const Size3 cropped = upper - lower;
  Affine indexToWorld = mask.grid.indexToWorld;
  indexToWorld.translate(lower.cast<double>());
  const auto fill = [&]<typename Label>(Label) -> Labels {
    LargeArray<Label> labels(static_cast<std::size_t>(cropped.prod()));
    for (const auto& [begin, end] : mask.runs) {
      const std::size_t to = linearIndex(findVoxel(begin) - lower, cropped);
      std::fill_n(labels.begin() + static_cast<std::ptrdiff_t>(to), end - begin,
                  static_cast<Label>(value));
    }
    return labels;
  };
  const Grid grid(cropped, indexToWorld);
  if (std::in_range<std::uint8_t>(value))
    return {grid, fill(std::uint8_t())};
  return {grid, fill(std::int32_t())};
}

} // namespace fenestra::core
