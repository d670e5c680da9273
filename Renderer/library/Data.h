#pragma once
// What the handles of the public interface hold.

#include "fenestra/Render.h"
#include "image/Image.h"
#include "scene/PreparedScene.h"

#include <mutex>

namespace fenestra {
inline namespace v1 {

struct Volume::Data {
  core::VolumeHandle input;
};

struct Segmentation::Data {
  core::SegmentsHandle input;
};

struct Scene::Data {
  core::Input input;
  core::RenderRequest request; ///< without size and features
  SceneOptions options;
  bool isReadInProcess = false;
  std::mutex mutex = {};
  std::optional<core::PreparedScene> prepared = {}; ///< for the last image

  /// The scene prepared for an image; sizes are pixels. Throws core::Error.
  core::PreparedScene prepare(int width, int height, bool hasFeatures);
};

struct Image::Data {
  int width, height;
  std::vector<float> rgba, denoised, depth, clipDepth, normals, albedo, error, sampleCounts;
  core::ImagePlane plane;
  bool isOrthographic;
  double noise, denoisedNoise;
  std::uint64_t samples;
  bool isComplete;
  std::map<std::string, std::string> metadata;
};

/// The renderer's request for the options, without size. Throws core::Error (request).
core::RenderRequest makeRequest(const SceneOptions& options);

} // namespace v1
} // namespace fenestra
