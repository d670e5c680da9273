#pragma once
// Meaning of a Slicer scene's nodes, as far as a picture depends on them. Each function takes the
// scene and a node, follows the node's references, and throws Error (input), naming the node, where
// a reference or a value cannot be honoured.

#include "files/segments/SegmentationReader.h"
#include "files/slicer/MrmlDocument.h"
#include "files/slicer/SceneFiles.h"
#include "model/camera/Camera.h"
#include "model/medium/TransferFunction.h"
#include "model/volume/Domain.h"
#include "model/volume/Volume.h"

#include <array>
#include <filesystem>
#include <map>
#include <string>
#include <variant>
#include <vector>

namespace fenestra {

struct MrmlScene {
  /// Enters every file that a node names into the ledger of inputs (SceneFiles::expect).
  explicit MrmlScene(const std::filesystem::path& path);

  SceneFiles files;
  MrmlDocument document;
  /// Result of reading each transform file, errors included: many nodes may name one file, and
  /// reading takes a child process.
  std::map<std::string, std::variant<Affine, Error>> transformFiles;
};

/// True for a label map: by its own tag, in older scenes by an attribute.
bool isLabelMap(const MrmlNode& node);
/// True for a segmentation or a label map.
bool isSegmentation(const MrmlNode& node);
bool isScalarVolume(const MrmlNode& node);
/// True for a display node of any volume rendering method.
bool isVolumeRendering(const MrmlNode& node);
/// True for a display node that shows its object in 3-D views.
bool isVisible(const MrmlNode& display);

/// Layout name, by which a view and its camera are paired; older scenes use singletonTag.
std::string layoutName(const MrmlNode& viewOrCamera);

/// File names of a node's storage, fileName first; empty: no storage.
std::vector<std::string> listStorageFiles(const MrmlScene& scene, const MrmlNode& node);

/// Ids of the transforms above a node, nearest first; each once in a loop, and at most as many as
/// toWorld follows.
std::vector<std::string> listParentTransforms(const MrmlDocument& document, const MrmlNode& node);

/// Map from the node's own space to the world, RAS mm: product of the linear transforms above it.
/// Storage files (all digits) win over the scene's matrices (six digits). Throws Error (input) for
/// a non-linear transform.
Affine toWorld(MrmlScene& scene, const MrmlNode& node);

/// Scalar volume, in the world. Geometry: the file's (not the scene's copy), changed by the storage
/// node's centerImage and UseOrientationFromFile.
Volume readSceneVolume(MrmlScene& scene, const MrmlNode& volume);

/// Segmentation or label map, in the world. Closed surfaces become labels on the grid of `volume`,
/// which is in the world as well.
Segmentation readSceneSegmentation(MrmlScene& scene, const MrmlNode& node,
                                   const Grid* volume = nullptr,
                                   const std::optional<std::string>& labels = {});

/// Segments of such a node, as readSegmentInfos has them. `labels`: names of a label map's values.
std::vector<SegmentInfo> readSceneSegmentInfos(MrmlScene& scene, const MrmlNode& node,
                                               const std::optional<std::string>& labels = {});

/// Visibility in 3-D by segment id, from the segmentation's display; segments that the map lacks
/// are visible.
std::map<std::string, bool> readSegmentVisibility(const MrmlScene& scene, const MrmlNode& node);

/// Transfer function from a volume property node's attributes.
TransferFunction readInlineProperty(const MrmlDocument& document, const MrmlNode& property);
/// Names of the volume properties, in file order.
std::vector<std::string> listPropertyNames(const MrmlDocument& document);

/// Transfer function of a volume property node: from its storage file, else from its attributes.
TransferFunction readSceneProperty(MrmlScene& scene, const MrmlNode& property);

/// Transfer function that Slicer derives from a volume's slice display for a rendering that follows
/// it (vtkSlicerVolumeRenderingLogic::CopyScalarDisplayToVolumeRenderingDisplayNode): opaque within
/// threshold or window, grey over the window. `range`: the volume's scalars. nullopt: no window, or
/// a colour table other than grey; then the saved property applies.
std::optional<TransferFunction> convertSliceDisplay(const MrmlNode& rendering,
                                                    const MrmlNode& display,
                                                    const std::array<double, 2>& range);

/// Region of interest of any age, in the world.
CropBox readSceneRoi(MrmlScene& scene, const MrmlNode& roi);

/// Pose of a camera node, in the world: Slicer stores it with the transform above it applied.
CameraPose readSceneCamera(MrmlScene& scene, const MrmlNode& camera);

/// Background of a view, display-encoded.
struct ViewBackground {
  Rgb bottom = Rgb::Zero(), top = Rgb::Zero();
};
ViewBackground readViewBackground(const MrmlNode& view);

} // namespace fenestra
