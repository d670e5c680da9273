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
  core::RenderRequest request;            ///< without size and features
  SceneOptions options;                   ///< as given
  std::optional<std::string> preset = {}; ///< name of the chosen one
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

/// Adds the options of the preset, if there is one, and sets its name to that of the chosen one.
/// `sources`: chooses among several volumes and segmentations. Returns the modality for which the
/// preset chose the transfer function, if it did. Throws core::Error (request, input).
std::optional<core::Modality>
applyPreset(const core::Input& input, const core::RenderRequest& sources, SceneOptions& options);

/// Sets the parts of the request that the options state. Throws core::Error (request).
void setOptions(const SceneOptions& options, core::RenderRequest& request);

} // namespace v1
} // namespace fenestra
