#pragma once
// What the handles of the public interface hold.

#include "fenestra/Render.h"
#include "image/Image.h"
#include "scene/OrganPresets.h"
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
  SceneOptions options;        ///< as given
  std::optional<core::ChosenPreset> preset = {};
  bool isReadInProcess = false;
  std::mutex mutex = {};
  std::optional<core::PreparedScene> prepared = {}; ///< for the last image

  /// The scene prepared for an image; sizes are pixels. Throws core::Error, also once `stop` is
  /// true.
  core::PreparedScene prepare(int width, int height, bool hasFeatures,
                              const core::StopFlag& stop = core::neverStopped);
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

/// Adds the focus and the options of a preset. Returns the modality for which it chose the transfer
/// function, if it did. Throws core::Error (input).
std::optional<core::Modality> applyPreset(const core::ChosenPreset& chosen, SceneOptions& options);

/// Sets the parts of the request that the options state. Throws core::Error (request).
void setOptions(const SceneOptions& options, core::RenderRequest& request);

} // namespace v1
} // namespace fenestra
