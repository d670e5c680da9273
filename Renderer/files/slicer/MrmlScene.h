#pragma once
// Interprets the nodes of a Slicer scene, as far as they affect the image. Each function follows
// the references of its node. It throws Error (input), stating the node, for a reference or value
// that cannot be used.

#include "files/medical/VolumeChoice.h"
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

namespace fenestra::core {

struct MrmlScene {
  /// Registers every file that a node names as an input (SceneFiles::registerInputs).
  explicit MrmlScene(const std::filesystem::path& path);

  SceneFiles files;
  MrmlDocument document;
  /// Result of reading each transform file, or its error. Many nodes may share a file, and reading
  /// needs a child process.
  std::map<std::string, std::variant<Affine, Error>> transformFiles;
};

/// True for a label map, identified by its own tag or, in older scenes, by an attribute.
bool isLabelMap(const MrmlNode& node);
/// True for a segmentation or a label map.
bool isSegmentation(const MrmlNode& node);
bool isScalarVolume(const MrmlNode& node);
/// True for a display node of any volume rendering method.
bool isVolumeRendering(const MrmlNode& node);
/// True for a display node whose object is visible in 3D views.
bool isVisible(const MrmlNode& display);

/// Layout name that pairs a view with its camera; older scenes use singletonTag.
std::string findLayoutName(const MrmlNode& viewOrCamera);

/// Files of a node's storage node, fileName first; empty: no storage node.
std::vector<std::string> listStorageFiles(const MrmlScene& scene, const MrmlNode& node);

/// Ids of the transforms above a node, nearest first. Stops at a loop, and at the depth at which
/// toWorld gives up.
std::vector<std::string> listParentTransforms(const MrmlDocument& document, const MrmlNode& node);

/// Node-to-world transform, RAS mm: the product of the linear transforms above the node. Transform
/// files (all digits) take precedence over matrices in the scene (six digits). Throws Error (input)
/// for a nonlinear transform.
Affine toWorld(MrmlScene& scene, const MrmlNode& node);

/// Reads a scalar volume into world space. The file gives the geometry, not the scene's copy of it;
/// centerImage and UseOrientationFromFile of the storage node modify it.
/// `choice`: of its file; the name is ignored.
Volume readSceneVolume(MrmlScene& scene, const MrmlNode& volume, const VolumeChoice& choice = {});

/// Reads a segmentation or label map into world space. Closed surfaces become labels on the grid
/// `volume`, which is in world space, too.
Segmentation readSceneSegmentation(MrmlScene& scene, const MrmlNode& node,
                                   const Grid* volume = nullptr,
                                   const std::optional<std::string>& labels = {});

/// Reads the segments of such a node, as readSegmentInfos does. `labels`: table of label names.
std::vector<SegmentInfo> readSceneSegmentInfos(MrmlScene& scene, const MrmlNode& node,
                                               const std::optional<std::string>& labels = {});

/// 3D visibility by segment id, from the segmentation's display node. Segments that the map lacks
/// are visible.
std::map<std::string, bool> readSegmentVisibility(const MrmlScene& scene, const MrmlNode& node);

/// Transfer function from the attributes of a volume property node.
TransferFunction readInlineProperty(const MrmlDocument& document, const MrmlNode& property);
/// Names of the volume properties, in file order.
std::vector<std::string> listPropertyNames(const MrmlDocument& document);

/// Transfer function of a volume property node: from its storage file, else from its attributes.
TransferFunction readSceneProperty(MrmlScene& scene, const MrmlNode& property);

/// Transfer function for a rendering that follows the volume's slice display, as Slicer derives it
/// (vtkSlicerVolumeRenderingLogic::CopyScalarDisplayToVolumeRenderingDisplayNode): opaque within
/// threshold or window, gray over the window. `range`: of the volume's scalars. nullopt: no window,
/// or a color table other than gray; use the saved volume property then.
std::optional<TransferFunction> convertSliceDisplay(const MrmlNode& rendering,
                                                    const MrmlNode& display,
                                                    const std::array<double, 2>& range);

/// Reads a region of interest, of any MRML version, into world space.
CropBox readSceneRoi(MrmlScene& scene, const MrmlNode& roi);

/// Camera pose in world space. Slicer stores it with the camera's transform already applied.
CameraPose readSceneCamera(MrmlScene& scene, const MrmlNode& camera);

/// Background colors of a view, display-encoded.
struct ViewBackground {
  Rgb bottom = Rgb::Zero(), top = Rgb::Zero();
};
ViewBackground readViewBackground(const MrmlNode& view);

} // namespace fenestra::core
