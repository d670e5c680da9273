#pragma once
// What the nodes of a Slicer scene mean, as far as a picture depends on it. Each function takes the
// scene and a node of it, follows the node's references, and throws Error (input) that names the
// node where it cannot be followed rightly.

#include "files/segments/SegmentationReader.h"
#include "files/slicer/MrmlDocument.h"
#include "files/slicer/SceneFiles.h"
#include "files/slicer/TransformFile.h"
#include "model/camera/Camera.h"
#include "model/medium/TransferFunction.h"
#include "model/volume/Domain.h"
#include "model/volume/Volume.h"

#include <array>
#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace fenestra {

struct MrmlScene {
  /// Enters every file that a node names into the ledger of inputs (SceneFiles::expect).
  explicit MrmlScene(const std::filesystem::path& path);

  SceneFiles files;
  MrmlDocument document;
  /// What each transform's file said, be it an error: nodes may name one often, and reading one
  /// takes a process.
  std::map<std::pair<std::string, TransformSense>, std::variant<Affine, Error>> transformFiles;
};

/// Label maps have a tag of their own now, and an attribute in older scenes.
bool isLabelMap(const MrmlNode& node);
bool isScalarVolume(const MrmlNode& node);
/// A display node of some volume rendering method.
bool isVolumeRendering(const MrmlNode& node);
/// A display node that shows its object in 3-D views.
bool isShown(const MrmlNode& display);

/// The name by which a view and its camera find each other; older scenes have it elsewhere.
std::string layoutOf(const MrmlNode& viewOrCamera);

/// Files of a node's storage, the first one first; empty where it has none.
std::vector<std::string> storedFiles(const MrmlScene& scene, const MrmlNode& node);

/// The ids of the transforms above a node, the nearest first; those of a loop once, of a chain as
/// many as toWorld follows.
std::vector<std::string> transformsAbove(const MrmlDocument& document, const MrmlNode& node);

/// The node's own space to the world, RAS mm: the product of the linear transforms above it. Their
/// storage files, which have all digits, win over the scene's own six. Non-linear ones are refused.
Affine toWorld(MrmlScene& scene, const MrmlNode& node);

/// A scalar volume, in the world. Its geometry is the file's (the scene's copy of it is not read)
/// with what the storage node says of it: centerImage, UseOrientationFromFile.
Volume readSceneVolume(MrmlScene& scene, const MrmlNode& volume);

/// A segmentation or a label map, in the world; closed surfaces become labels on the grid of
/// `volume`, which is in the world, too.
Segmentation readSceneSegmentation(MrmlScene& scene, const MrmlNode& node,
                                   const Grid* volume = nullptr);

/// What names its segments, without their labels; empty where the file names none.
std::vector<SegmentInfo> readSceneSegmentInfos(MrmlScene& scene, const MrmlNode& node);

/// Whether each segment is shown in 3-D, by id, as the segmentation's display says; segments that
/// it does not name are.
std::map<std::string, bool> segmentVisibility(const MrmlScene& scene, const MrmlNode& node);

/// What a volume property node says: its storage file, else its own attributes.
TransferFunction readSceneProperty(MrmlScene& scene, const MrmlNode& property);

/// What Slicer makes of a volume's slice display where a rendering follows it
/// (vtkSlicerVolumeRenderingLogic::CopyScalarDisplayToVolumeRenderingDisplayNode): opaque by its
/// threshold or window, grey over its window. `range` is the volume's. Nothing where the display
/// has no window, or a colour table other than grey: then the saved property is what is known.
std::optional<TransferFunction> followedDisplay(const MrmlNode& rendering, const MrmlNode& display,
                                                const std::array<double, 2>& range);

/// A region of interest of any age, with the transforms above it.
CropBox readSceneRoi(MrmlScene& scene, const MrmlNode& roi);

/// A camera node, in the world: Slicer stores it with the transform above it applied.
CameraPose readSceneCamera(MrmlScene& scene, const MrmlNode& camera);

/// Display-encoded colours of a view's background.
struct ViewBackground {
  Rgb bottom = Rgb::Zero(), top = Rgb::Zero();
};
ViewBackground viewBackground(const MrmlNode& view);

} // namespace fenestra
