#pragma once
// Contents of an input, and the parts that a render would use: plain data, for `fenestra inspect`.
// Lengths are in mm, places in the world (RAS). Nodes refer to each other by id; empty: none. Text
// is unchanged from the files: printers have to escape control characters.

#include "model/camera/Camera.h"
#include "model/volume/Volume.h"
#include "session/RenderRequest.h"

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace fenestra {

struct FileSummary {
  std::string name; ///< as in the scene, URL escapes decoded
  bool there = true;
};

/// Common part of all nodes. `problem`: line of the error on reading the node; empty: none.
struct NodeSummary {
  std::string id, name;
  std::vector<FileSummary> files = {};
  std::string transform = {}; ///< id of the transform right above the node
  bool used = false;          ///< true: a render uses the node
  std::string problem = {};
};

struct SegmentSummary {
  std::string id, name;
  std::int32_t labelValue = 1;
  std::size_t layer = 0;
  Rgb color = Rgb::Zero(); ///< display-encoded
  std::int64_t voxels = 0;
  double milliliters = 0.0;
  Box bounds = {}; ///< of the segment's voxels; empty (at 0): none
  bool shown = true;
};

/// Segmentation or label map; no segments if node.problem is set.
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
  bool followsDisplay = false; ///< look: the slice display's window
  bool shown = true;           ///< in Slicer's 3-D views
};

struct ViewSummary {
  NodeSummary node;
  std::string layout, technique;
  Rgb bottom = Rgb::Zero(), top = Rgb::Zero(); ///< background, display-encoded
};

struct CameraSummary {
  NodeSummary node;
  std::string layout;                  ///< of the camera's view
  std::optional<CameraPose> pose = {}; ///< nothing: the node has a problem
};

struct TransformSummary {
  NodeSummary node;
  std::optional<Affine> toWorld = {}; ///< with all transforms above; nothing: one has a problem
};

struct SeriesSummary {
  std::string uid, number, description, modality;
  std::size_t files = 0;
};

struct VolumeUse {
  std::string id, name;
  Size3 size;
  Vec3 spacing, center;
  std::string voxelType; ///< in memory: uint8, int16, uint16 or float
  double minimum, maximum;
  std::vector<std::string> transforms = {}; ///< ids of those above the volume, nearest first
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
  std::string id, name; ///< empty: no camera, a default view
  CameraPose pose;
};

struct BackgroundUse {
  std::string view; ///< id
  Rgb bottom, top;  ///< display-encoded
};

/// Parts that a render uses. Nothing: none, or unreadable (Inspection::refused says why).
struct RenderUse {
  std::optional<VolumeUse> volume = {};
  std::optional<LookUse> look = {};
  std::optional<CropUse> crop = {};
  std::optional<CameraUse> camera = {};
  std::optional<BackgroundUse> background = {};
  std::string segmentation = {};        ///< id or file that is searched for a focus
  std::string segmentationProblem = {}; ///< reason why `segmentation` is undecided
  std::vector<std::string> stored = {}; ///< flags stored in the scene by Fenestra's extension
};

enum class InputKind { scene, volume, segmentation, dicom };

struct Inspection {
  InputKind kind = InputKind::volume;
  std::string version = {}; ///< of Slicer, from the scene
  std::vector<NodeSummary> volumes = {};
  std::vector<SegmentationSummary> segmentations = {};
  std::vector<RenderingSummary> renderings = {};
  std::vector<NodeSummary> properties = {};
  std::vector<NodeSummary> rois = {};
  std::vector<ViewSummary> views = {};
  std::vector<CameraSummary> cameras = {};
  std::vector<TransformSummary> transforms = {};
  std::vector<SeriesSummary> series = {};
  std::map<std::string, std::size_t> others = {}; ///< number of other nodes, by tag

  std::optional<RenderUse> render = {}; ///< nothing: undecided what a render shows
  std::string refused = {};             ///< error line of a render; empty: success
  std::vector<std::string> warnings = {};
  std::vector<std::string> ignored = {};
};

/// Uses only request.input, .volume and .segmentation. Reads the files that a render would, and
/// every segmentation, camera and transform (after 64 of a kind only names). Throws Error if the
/// input is neither scene nor volume nor segmentation.
Inspection inspectInput(const SceneRequest& request);

} // namespace fenestra
