#pragma once
// What an input holds, and what a render of it would use: plain data, for `fenestra inspect`.
// Lengths are in mm, places in the world (RAS); nodes refer to each other by id, empty where there
// is none. Text is as the files have it: whoever prints it sees to control characters.

#include "model/camera/Camera.h"
#include "model/volume/Volume.h"
#include "session/RenderRequest.h"

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace fenestra {

struct FileSummary {
  std::string name; ///< as the scene has it, with its URL escapes undone
  bool there = true;
};

/// What every node has. `problem` is the line of the error that reading it ended in, else empty.
struct NodeSummary {
  std::string id, name;
  std::vector<FileSummary> files = {};
  std::string transform = {}; ///< the one right above it
  bool used = false;          ///< by a render
  std::string problem = {};
};

struct SegmentSummary {
  std::string id, name;
  std::int32_t labelValue = 1;
  std::size_t layer = 0;
  Rgb color = Rgb::Zero(); ///< display-encoded
  std::int64_t voxels = 0;
  double milliliters = 0.0;
  Box bounds = {}; ///< of its voxels; empty (at 0) without any
  bool shown = true;
};

/// A segmentation or a label map; without segments where it has a problem.
struct SegmentationSummary {
  NodeSummary node;
  bool isLabelMap = false;
  bool shown = true; ///< in Slicer's 3-D views; label maps count as shown
  Size3 size = Size3::Zero();
  Vec3 spacing = Vec3::Zero();
  std::vector<SegmentSummary> segments = {};
};

struct RenderingSummary {
  NodeSummary node;
  std::string volume, property, roi;
  bool cropping = false;
  bool followsDisplay = false; ///< its look is the slice display's window
  bool shown = true;           ///< in Slicer's 3-D views
};

struct ViewSummary {
  NodeSummary node;
  std::string layout, technique;
  Rgb bottom = Rgb::Zero(), top = Rgb::Zero(); ///< background, display-encoded
};

struct CameraSummary {
  NodeSummary node;
  std::string layout;                  ///< of the view that it belongs to
  std::optional<CameraPose> pose = {}; ///< nothing where it has a problem
};

struct TransformSummary {
  NodeSummary node;
  std::optional<Affine> toWorld = {}; ///< with all above it; nothing where one has a problem
};

struct SeriesSummary {
  std::string uid, number, description, modality;
  std::size_t files = 0;
};

struct VolumeUse {
  std::string id, name;
  Size3 size;
  Vec3 spacing, center;
  std::string voxelType; ///< as it is kept: uint8, int16, uint16 or float
  double minimum, maximum;
  std::vector<std::string> transforms = {}; ///< that move it, the nearest first
};

enum class LookSource { volumeProperty, volumeDisplay, preset, range };

struct LookUse {
  LookSource source;
  std::string id, name;
};

struct CropUse {
  std::string id, name;
  Vec3 edges, center;
};

struct CameraUse {
  std::string id, name; ///< empty where the view is framed for want of a camera
  CameraPose pose;
};

struct BackgroundUse {
  std::string view; ///< its id
  Rgb bottom, top;  ///< display-encoded
};

/// Each is nothing where it cannot be read (Inspection::refused says why), or there is none.
struct RenderUse {
  std::optional<VolumeUse> volume = {};
  std::optional<LookUse> look = {};
  std::optional<CropUse> crop = {};
  std::optional<CameraUse> camera = {};
  std::optional<BackgroundUse> background = {};
  std::string segmentation = {};        ///< a focus is looked for in it: an id, or a file
  std::string segmentationProblem = {}; ///< why that is open
  std::vector<std::string> stored = {}; ///< flags that the scene has from Fenestra's extension
};

enum class InputKind { scene, volume, segmentation, dicom };

struct Inspection {
  InputKind kind = InputKind::volume;
  std::string version = {}; ///< of Slicer, as the scene has it
  std::vector<NodeSummary> volumes = {};
  std::vector<SegmentationSummary> segmentations = {};
  std::vector<RenderingSummary> renderings = {};
  std::vector<NodeSummary> properties = {};
  std::vector<NodeSummary> rois = {};
  std::vector<ViewSummary> views = {};
  std::vector<CameraSummary> cameras = {};
  std::vector<TransformSummary> transforms = {};
  std::vector<SeriesSummary> series = {};
  std::map<std::string, std::size_t> others = {}; ///< how many, by tag

  std::optional<RenderUse> render = {}; ///< nothing where it is open what would be rendered
  std::string refused = {};             ///< the line that a render ends in; empty where it works
  std::vector<std::string> warnings = {};
  std::vector<std::string> ignored = {};
};

/// Of the request the input, the volume and the segmentation count. Reads what a render would, and
/// every segmentation, camera and transform (of more than 64 of a kind the rest is only named).
/// Throws Error where the input is neither scene nor volume nor segmentation.
Inspection inspectInput(const SceneRequest& request);

} // namespace fenestra
