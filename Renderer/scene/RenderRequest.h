#pragma once
// A render request: plain data, filled by the command line or by another client.

#include "base/Error.h"
#include "clip/surface/ClippingSurface.h"
#include "denoise/features/FeatureBuffers.h"
#include "files/medical/VolumeChoice.h"
#include "integrator/render/Render.h"
#include "model/camera/Camera.h"
#include "model/filtering/SmoothingRequest.h"
#include "model/masks/MaskShaping.h"
#include "model/medium/TransferFunction.h"
#include "model/volume/Volume.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace fenestra::core {

enum class ClipMode { none, plane, cutaway, surface, hole, ghost };

/// True for clips that are depth buffers; they require a focus.
constexpr bool isDepthClip(ClipMode mode) {
  return mode != ClipMode::none && mode != ClipMode::plane;
}

struct PlaneRequest {
  Vec3 origin, normal; ///< RAS mm; the side to which the normal points is removed

  bool operator==(const PlaneRequest&) const = default;
};

/// Default width of the soft edge behind a clip through a focus, mm.
inline constexpr double defaultSoftness = 0.6;

struct ClipRequest {
  std::optional<ClipMode> mode = {};      ///< by default `surface` with a focus, else `none`
  std::optional<PlaneRequest> plane = {}; ///< by default a plane fitted to the focus
  double ghost = 0.1; ///< fraction of the extinction that remains in front of the surface (`ghost`)
  /// Width of the soft edge behind the cut, mm; by default defaultSoftness in the modes surface,
  /// hole and cutaway, else 0.
  std::optional<double> softness = {};
  /// A plane uses only the offset. `mode` and `softness` replace the corresponding members.
  SurfaceOptions surface = {.boundary = Boundary::exact};

  ClipMode resolveMode(bool hasFocus) const {
    return mode.value_or(hasFocus ? ClipMode::surface : ClipMode::none);
  }

  bool operator==(const ClipRequest&) const = default;
};

/// Conversion of the focus labels to a mask, and appearance of the context. The labels of materials
/// are smoothed like those of the focus.
struct FocusRequest {
  MaskShaping shaping = {.smoothing = std::nullopt};
  /// Applies an OrganMargin to each segment of the focus if the volume seems to be CT.
  bool hasOrganMargin = true;
  double contextExtinction = 1.0; ///< factor of the extinction outside the focus, 0 to 1
  /// Factor of the color saturation outside the focus, 0 to 1: of the materials' colors in CIELAB
  /// (ColorAdjustment), without materials of the albedo (ContextStyle). By default what a file of
  /// materials states or "contrast" finds, else defaultContextSaturation (Contrast.h); 1 with a
  /// file that does neither.
  std::optional<double> contextSaturation = {};

  bool operator==(const FocusRequest&) const = default;
};

/// Camera request: a named direction, or a pose whose unset members are derived from the scene.
struct ViewRequest {
  std::optional<Projection> projection = {}; ///< by default the scene's, else orthographic
  /// anterior, posterior, left, right, superior, inferior, or auto (AutomaticView.h; needs a focus)
  std::optional<std::string> name = {};
  std::optional<Vec3> position = {}, target = {}, up = {};
  std::optional<double> scale = {}; ///< orthographic: half the viewport's height, mm
  std::optional<double> angle = {}; ///< perspective: full vertical angle, degrees

  /// True if the camera of a Slicer scene applies, modified by the other members.
  bool isSceneCamera() const { return !name && !position; }
  bool isAutomatic() const { return name == "auto"; }

  bool operator==(const ViewRequest&) const = default;
};

/// RenderRequest::materials for rendering with the volume's own colors.
inline constexpr const char* noMaterials = "none";

/// Library materials, adjusted so that the focus contrasts with its surroundings (TintContrast.h).
inline constexpr const char* contrastMaterials = "contrast";
/// Library materials. Around a focus, the context has defaultContextSaturation by default.
inline constexpr const char* libraryMaterials = "library";

/// --table
enum class TableRequest { automatic, keep, remove };

struct RenderRequest {
  std::filesystem::path input; ///< a volume, a DICOM folder, or a Slicer scene
  VolumeChoice volume = {};    ///< if there are several
  bool isStrict = false;       ///< an input about which anything is assumed is an error
  std::optional<std::string> segmentation = {}; ///< node of the scene, or a file
  std::optional<std::string> labels = {};       ///< names of label values (LabelSearch.h)
  std::vector<std::string> focus = {};          ///< ids, names or label values
  /// "none", "library", "contrast", or a file. By default "library" in CT if a focus segment has a
  /// known material, else "none".
  std::optional<std::string> materials = {};
  std::vector<std::string> materialChanges = {}; ///< arguments of parseMaterialChange
  std::optional<std::string> transfer =
      {}; ///< file or preset name; by default the scene's, else derived from the volume
  /// Smoothing of the volume. `automatic`: with estimated noise; whether the outputs allow it is
  /// already decided (isSmoothed).
  SmoothingRequest smoothing = {};
  TableRequest table = TableRequest::automatic; ///< of the scanner
  double shift = 0.0;
  double density = 1.0;
  GradientKind gradient = GradientKind::sobel;
  /// File, preset name, or inline JSON; by default theatre-wet, whose highlights suit cut organs,
  /// with a focus, else theatre, whose stronger shade suits skin and bone.
  std::optional<std::string> lights = {};
  std::optional<Rgb> environment = {}; ///< replaces the lights' own environment
  std::optional<std::filesystem::path> environmentMap = {};
  ViewRequest view;
  ClipRequest clip;
  int width = 512, height = 512;
  bool features = false; ///< compute the feature buffers of the denoiser
  /// A coarse preview: feature buffers of one ray per pixel; volume and labels are not smoothed
  /// unless an earlier scene has smoothed them.
  bool isDraft = false;
  bool measure = false; ///< measure the clip; traces the focus even if no clip needs it
  FocusRequest focusStyle = {};
  /// Half-width of the angular window over which a turntable's clipping surface is smoothed,
  /// degrees (clip/surface/SteadySurface.h).
  double steadyDegrees = 0.0;
  /// Modality for which an organ preset chose `transfer`. A volume of another modality gets a
  /// default transfer function, and a warning.
  std::optional<Modality> transferModality = {};
  /// Ignored parts of the user's request, with reasons; they precede the scene's warnings.
  std::vector<Message> omissions = {};

  std::string lightsName() const {
    return lights.value_or(focus.empty() ? "theatre" : "theatre-wet");
  }
};

} // namespace fenestra::core
