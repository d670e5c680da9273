#pragma once
// Input of a request: a volume file, a DICOM folder, a stack of images, or a Slicer scene with its
// settings; or a volume and a segmentation in memory.

#include "base/Error.h"
#include "files/segments/SegmentationReader.h"
#include "model/camera/Background.h"
#include "model/camera/Camera.h"
#include "model/medium/TransferFunction.h"
#include "model/volume/Domain.h"
#include "model/volume/Volume.h"
#include "scene/RenderRequest.h"

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace fenestra::core {

class MrmlDocument;
struct DicomFolder;
struct MrmlScene;

/// True for a folder that is no stack of images, and for a DICOM file under any name but that of
/// another volume format.
bool isDicomInput(const std::filesystem::path& path);

/// Paths of the files that were read, as the user named them.
using InputFiles = std::vector<std::string>;

struct VolumeInput {
  Volume volume;
  InputFiles files = {};
};

/// View and crop of a Slicer scene; empty for other inputs.
struct SceneSettings {
  std::optional<CropBox> crop = {};
  std::optional<CameraPose> camera = {};
  std::optional<Background> background = {};
  std::vector<Message> warnings = {};
  InputFiles files = {};
};

/// Transfer function of a Slicer scene; empty if the scene has none.
struct SceneTransfer {
  std::optional<TransferFunction> transfer = {};
  std::string name = {}; ///< of the volume property
  InputFiles files = {};
};

struct SegmentsInput {
  Segmentation segmentation;
  InputFiles files = {};
};

/// Names of all segments among which a focus is searched. Needs no voxels of the label map.
struct SegmentNames {
  std::string source;                ///< describes the segmentation in messages
  std::vector<SegmentInfo> segments; ///< empty: the segments have no names
};

/// Selects nodes of a scene, or files (RenderRequest).
struct InputChoice {
  std::optional<std::string> volume = {};
  std::optional<std::string> segmentation = {};
  std::optional<std::string> labels = {}; ///< names of label values (LabelSearch.h)
  /// Segments; they select among several segmentations of a scene (FocusNodes.h).
  std::vector<std::string> focus = {};

  bool operator==(const InputChoice&) const = default;
};

using VolumeHandle = std::shared_ptr<const VolumeInput>;
using SegmentsHandle = std::shared_ptr<const SegmentsInput>;

/// The input is opened once, on first use. Copies share the opened scene, its unpacked files and
/// its transforms. Files are assumed not to change. All methods throw Error and are thread-safe.
class Input {
public:
  explicit Input(std::filesystem::path path);
  /// In memory; `segments`: null: none. Choices among several are ignored.
  Input(VolumeHandle volume, SegmentsHandle segments);

  /// Empty in memory.
  const std::filesystem::path& path() const;
  /// True if the input is a scene or DICOM folder with several segmentations.
  bool hasSeveralSegmentations() const;
  /// The stored scene; null if the input is not a Slicer scene.
  const MrmlDocument* document() const;
  /// The opened scene, shared, for single-threaded use; null if the input is not a Slicer scene.
  MrmlScene* scene() const;

  /// The chosen segmentation; without one, the only SEG or RTSTRUCT beside a DICOM series that
  /// refers to it, or of several the only one with all segments of the focus. Throws Error (input)
  /// if there are several.
  std::optional<std::string> segmentationFile(const InputChoice& choice) const;
  /// What the folder, or the folder of the DICOM file, holds; null if the input is neither.
  const DicomFolder* dicom() const;
  /// Warning about segmentations of a DICOM series, for a render that uses none.
  std::vector<Message> findUnusedSegmentations(const std::optional<std::string>& volume) const;

  VolumeHandle volume(const VolumeChoice& choice) const;
  /// Adds the form of a NIfTI volume that agrees with the segmentation file (NiftiForms.h).
  VolumeChoice chooseForm(const VolumeChoice& given,
                          const std::optional<std::string>& segmentation) const;
  /// `followsCamera`: also reads the scene's camera.
  SceneSettings settings(const std::optional<std::string>& volume, bool followsCamera) const;
  /// Transfer function of the volume's rendering in Slicer. `range`: of the voxels; needed for
  /// renderings that follow the window and level of the slice views.
  SceneTransfer transfer(const std::optional<std::string>& volume,
                         const std::array<double, 2>& range) const;
  /// Empty without a segmentation. Of several in a scene, of which none is chosen, those of all
  /// visible ones, else of all.
  std::optional<SegmentNames> segmentNames(const InputChoice& choice) const;
  /// Segmentation for a volume on the given grid; without a grid, closed surfaces get their own.
  SegmentsHandle segments(const InputChoice& choice, const std::optional<Grid>& volume = {}) const;
  /// Volume property with this name or id.
  SceneTransfer property(const std::string& name) const;
  std::vector<std::string> propertyNames() const;

  /// Compares files by their paths only.
  bool operator==(const Input& other) const {
    return m_state == other.m_state || (!path().empty() && path() == other.path());
  }

private:
  struct SharedState;

  VolumeInput readVolumeInput(const VolumeChoice& choice) const;
  SegmentsInput readSegments(const InputChoice& choice, const Grid* grid) const;

  std::shared_ptr<SharedState> m_state;
};

} // namespace fenestra::core
