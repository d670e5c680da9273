#pragma once
// A small scene for tests of the public interface, which includes nothing of the renderer.

#include "fenestra/Fenestra.h"

#include <cmath>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace fenestra::testing_library {

inline constexpr int edge = 24; // voxels
inline constexpr Affine millimeters = {{{2, 0, 0, -24}, {0, 2, 0, -24}, {0, 0, 2, -24}}};

/// Voxels of a ball in a block, i fastest.
template <typename T>
std::vector<T> makeBall(double inside, double outside) {
  std::vector<T> voxels;
  for (int k = 0; k < edge; ++k)
    for (int j = 0; j < edge; ++j)
      for (int i = 0; i < edge; ++i) {
        const double distance = std::hypot(i - 11.5, j - 11.5, k - 11.5);
        voxels.push_back(static_cast<T>(distance < 6.0 ? inside + i - 2 * j : outside + k));
      }
  return voxels;
}

inline Samples pack(const auto& voxels, SampleType type) {
  return {.data = voxels.data(), .type = type, .size = {edge, edge, edge}};
}

struct Ball {
  std::vector<std::int16_t> voxels = makeBall<std::int16_t>(300, 40);
  std::vector<std::uint8_t> labels;
  Volume volume{pack(voxels, SampleType::int16), millimeters, {.modality = Modality::ct}};
  Segmentation segments;

  Ball()
      : labels(makeLabels()),
        segments(pack(labels, SampleType::uint8), millimeters, {{3, "ball"}}) {}

private:
  std::vector<std::uint8_t> makeLabels() const {
    std::vector<std::uint8_t> all;
    for (const std::int16_t voxel : voxels)
      all.push_back(voxel > 150 ? 3 : 0);
    return all;
  }
};

inline SceneOptions makeOptions() {
  SceneOptions options;
  options.focus = {"ball"};
  options.appearance.smoothing.kind = VolumeSmoothing::Kind::off;
  return options;
}

inline RenderOptions makeSmall(std::uint64_t samples = 2) {
  return {.width = 24, .height = 16, .samples = samples};
}

inline std::vector<float> copy(std::span<const float> values) {
  return {values.begin(), values.end()};
}

inline std::string findCode(const auto& work) {
  try {
    work();
  } catch (const Error& error) {
    return error.code();
  }
  return "no error";
}

} // namespace fenestra::testing_library
