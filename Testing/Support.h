#pragma once
// Small scenes and statistics shared by tests.

#include "base/InstructionSets.h"
#include "integrator/render/Render.h"

#include <cstdint>
#include <cstdlib>
#include <memory>
#include <vector>

namespace fenestra::core::testing {

/// Selects FENESTRA_INSTRUCTIONS at the start of any program that includes this header, as
/// `fenestra` does. The program ends if the machine lacks that instruction set.
inline const bool instructionSetIsPinned = [] {
  const char* name = std::getenv("FENESTRA_INSTRUCTIONS");
  if (name)
    useInstructionSet(name);
  return name != nullptr;
}();

/// A grid centered at the origin with its axes along RAS.
inline Grid makeCenteredGrid(const Size3& size, const Vec3& spacing) {
  Affine map = Affine::Identity();
  map.linear() = Mat3::Diagonal(spacing);
  map.translation() = -0.5 * spacing.cwiseProduct((size.array() - 1).matrix().cast<double>());
  return {size, map};
}

template <typename Voxel = float, typename Function>
Volume makeVolume(const Grid& grid, Function&& value) {
  LargeArray<Voxel> voxels;
  voxels.reserve(static_cast<std::size_t>(grid.voxelCount()));
  for (std::int64_t k = 0; k < grid.size.z(); ++k)
    for (std::int64_t j = 0; j < grid.size.y(); ++j)
      for (std::int64_t i = 0; i < grid.size.x(); ++i)
        voxels.push_back(static_cast<Voxel>(
            value(Vec3(static_cast<double>(i), static_cast<double>(j), static_cast<double>(k)))));
  Volume volume{grid, std::move(voxels), 0.0, 0.0, "test volume", {}};
  computeRange(volume);
  return volume;
}

inline ScalarFunction::Knot makeKnot(double s, double sigma_t) {
  return {s, ScalarFunction::Value(sigma_t)};
}

/// Extinction sigma_t * s (mm^-1, s: scalar) and one albedo for all scalars.
inline TransferFunction makeLinearTransfer(double sigma_t, const Rgb& albedo, double g = 0.0) {
  TransferFunction transfer{
      ScalarFunction({{0.0, ScalarFunction::Value(0.0)}, {1.0, ScalarFunction::Value(sigma_t)}}),
      ColorFunction({{0.0, albedo}})};
  transfer.g = g;
  return transfer;
}

/// Label weights of parts that are all in memory.
inline LabelWeights makeLabelWeights(const std::vector<LabelWeights::Part>& parts) {
  return {parts.size(), [&](std::size_t i) { return parts[i]; }};
}

/// Owns everything that a SceneView refers to.
struct TestScene {
  Volume volume;
  TransferFunction transfer;
  std::vector<Light> lights;
  CameraPose pose;
  int width = 16, height = 16;
  Clip clip = {};
  std::optional<CropBox> crop = {};
  std::optional<ContextStyle> style = {};
  std::optional<Tint> tint = {};
  std::optional<Mixture> mixture = {}; ///< instead of a tint

  /// Returns work(SceneView).
  template <typename Work>
  auto visitView(Work&& work) const {
    const Camera camera(pose, width, height);
    const LightSet lightSet(lights, volume.grid, camera);
    const MinMaxGrid ranges(volume, MajorantGrid::requiredPadding(transfer));
    const ContextStyle* const contextStyle = style ? &*style : nullptr;
    const Mixture* const sceneMixture = mixture ? &*mixture : nullptr;
    const MajorantGrid majorants(volume.grid, ranges, transfer, clip, contextStyle, sceneMixture);
    return work(SceneView{volume, transfer, majorants, lightSet, camera, clip, crop, contextStyle,
                          tint ? &*tint : nullptr, sceneMixture});
  }

  RenderResult render(const RenderSettings& settings) const {
    RenderMonitor monitor;
    return visitView(
        [&](const SceneView& scene) { return fenestra::core::render(scene, settings, monitor); });
  }
};

/// Mean and standard error over all pixels and channels, from the pixels' means. Requires that all
/// pixels estimate the same value.
struct Estimate {
  double mean = 0.0, error = 0.0;
};

inline Estimate estimateMean(const Film& film) {
  Estimate estimate;
  double variance = 0.0;
  for (const PixelSums& pixel : film.pixels()) {
    estimate.mean += pixel.mean.mean();
    // Channels of a path are correlated: error of their mean <= mean of their errors.
    variance += std::pow(pixel.standardError().mean(), 2.0);
  }
  const auto n = static_cast<double>(film.pixelCount());
  estimate.mean /= n;
  estimate.error = std::sqrt(variance) / n;
  return estimate;
}

} // namespace fenestra::core::testing
