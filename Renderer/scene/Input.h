#pragma once
// Input of a request: a volume's file, a DICOM folder, or a Slicer scene with its settings.

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

namespace fenestra {

class MrmlDocument;
struct MrmlScene;

/// Paths of read files, as the user knows them.
using InputFiles = std::vector<std::string>;

struct VolumeInput {
  Volume volume;
  InputFiles files = {};
};

/// View and crop of a Slicer scene; nothing for other inputs.
struct SceneSettings {
  std::optional<CropBox> crop = {};
  std::optional<CameraPose> camera = {};
  std::optional<Background> background = {};
  std::vector<std::string> warnings = {};
  InputFiles files = {};
};

/// Transfer function of a Slicer scene; nothing where the scene has none.
struct SceneTransfer {
  std::optional<TransferFunction> transfer = {};
  std::string name = {}; ///< of the volume property
  InputFiles files = {};
};

struct SegmentsInput {
  Segmentation segmentation;
  InputFiles files = {};
};

/// Names of all segments that would be searched for a focus, without labels.
struct SegmentNames {
  std::string source;                ///< names the segmentation in messages
  std::vector<SegmentInfo> segments; ///< empty: segments have no names
};

/// Choice of a scene's nodes, or of files (RenderRequest).
struct InputChoice {
  std::optional<std::string> volume = {};
  std::optional<std::string> segmentation = {};
  std::optional<std::string> labels = {}; ///< names of a label map's values (LabelSearch.h)

  bool operator==(const InputChoice&) const = default;
};

/// Opened on first use, and then once: copies share an opened scene, its unpacked files and read
/// transforms. Files are assumed unchanged. All methods throw Error, and may be called from any
/// thread.
class Input {
public:
  explicit Input(std::filesystem::path path);

  const std::filesystem::path& path() const;
  /// Scene as stored; null: no Slicer scene.
  const MrmlDocument* document() const;
  /// Opened scene, shared, for a process that uses it in one thread; null: no Slicer scene.
  MrmlScene* scene() const;

  /// `choice`: of a scene's volumes, or of a folder's DICOM series.
  VolumeInput volume(const std::optional<std::string>& choice) const;
  /// `followsCamera`: reads the scene's camera.
  SceneSettings settings(const std::optional<std::string>& volume, bool followsCamera) const;
  /// Look of the volume's rendering in Slicer. `range`: of the voxels, for a look that follows the
  /// window of the slice views.
  SceneTransfer transfer(const std::optional<std::string>& volume,
                         const std::array<double, 2>& range) const;
  /// Nothing without a segmentation.
  std::optional<SegmentNames> segmentNames(const InputChoice& choice) const;
  /// Labels, for a volume of that grid.
  SegmentsInput segments(const InputChoice& choice, const Grid& volume) const;
  /// Volume property of that name or id.
  SceneTransfer property(const std::string& name) const;
  std::vector<std::string> propertyNames() const;

  /// Equal paths.
  bool operator==(const Input& other) const { return path() == other.path(); }

private:
  struct SharedState;

  std::shared_ptr<SharedState> m_state;
};

} // namespace fenestra
