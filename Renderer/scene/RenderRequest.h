#pragma once
// Request of a user: plain data, filled by the command line (or another driver of a render).

#include "clip/surface/ClippingSurface.h"
#include "integrator/render/Render.h"
#include "model/camera/Camera.h"
#include "model/masks/MaskShaping.h"
#include "model/volume/Volume.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace fenestra {

enum class ClipMode { none, plane, cutaway, surface, hole, ghost };

/// True for clips by a depth buffer, which need a focus.
constexpr bool isDepthClip(ClipMode mode) {
  return mode != ClipMode::none && mode != ClipMode::plane;
}

struct PlaneRequest {
  Vec3 origin, normal; ///< RAS mm; the side that the normal points at is removed

  bool operator==(const PlaneRequest&) const = default;
};

struct ClipRequest {
  std::optional<ClipMode> mode = {}; ///< by default `surface` when there is a focus, else `none`
  std::optional<PlaneRequest> plane = {}; ///< by default the focus's own (fitFocusPlane)
  double ghost = 0.1; ///< share of the extinction left in front of the surface, in mode `ghost`
  /// mm behind the cut over which matter comes back; nothing: as far as the focus's labels are
  /// uncertain (chooseSmoothing) in the modes surface, hole and cutaway, else 0.
  std::optional<double> softness = {};
  /// A plane takes its offset; `mode` and `softness` decide its mode and its edge.
  SurfaceOptions surface = {};

  ClipMode resolveMode(bool hasFocus) const {
    return mode.value_or(hasFocus ? ClipMode::surface : ClipMode::none);
  }

  bool operator==(const ClipRequest&) const = default;
};

/// Shaping of the focus's labels into a mask (materials' labels are smoothed alike), and look of
/// the context.
struct FocusRequest {
  MaskShaping shaping = {.smoothing = std::nullopt};
  double contextExtinction = 1.0; ///< factor of the extinction outside the focus, 0 to 1
  /// Factor of the colours' saturation there, 0 to 1; nothing: 1 with materials, else by the
  /// contrast (Contrast.h).
  std::optional<double> contextSaturation = {};

  bool operator==(const FocusRequest&) const = default;
};

/// Position of the eye: a named direction, or a pose, its unset members derived from the scene.
struct ViewRequest {
  std::optional<Projection> projection = {}; ///< by default the scene's, else orthographic
  /// anterior, posterior, left, right, superior, inferior; auto: AutomaticView.h, with a focus
  std::optional<std::string> name = {};
  std::optional<Vec3> position = {}, target = {}, up = {};
  std::optional<double> scale = {}; ///< orthographic: half the viewport's height, mm
  std::optional<double> angle = {}; ///< perspective: full vertical angle, degrees

  /// True: the camera of a Slicer scene applies, changed by the other members set here.
  bool isSceneCamera() const { return !name && !position; }
  bool isAutomatic() const { return name == "auto"; }

  bool operator==(const ViewRequest&) const = default;
};

/// RenderRequest::materials of a picture in the volume's own colours.
inline constexpr const char* noMaterials = "none";

/// Materials of the library, with the focus's contrast made sure of (TintContrast.h).
inline constexpr const char* autoMaterials = "auto";

struct RenderRequest {
  std::filesystem::path input;                  ///< a volume, a DICOM folder, or a Slicer scene
  std::optional<std::string> volume = {};       ///< choice among several: a node, or a DICOM series
  std::optional<std::string> segmentation = {}; ///< a node of the scene, or a file
  std::optional<std::string> labels = {};       ///< names of a label map's values (LabelSearch.h)
  std::vector<std::string> focus = {};          ///< ids, names or label values
  /// "none", "auto", "library", or a file over it; nothing: auto around a focus of which something
  /// is known, unless the context's saturation is given; else none.
  std::optional<std::string> materials = {};
  std::vector<std::string> materialChanges = {}; ///< parseMaterialChange's texts
  std::optional<std::string> transfer =
      {}; ///< a file, or a preset's name; by default the scene's, else from the volume
  double shift = 0.0;
  double density = 1.0;
  std::string lights = "cinema";       ///< a file, a preset's name, or the JSON itself
  std::optional<Rgb> environment = {}; ///< replaces the lights' own environment
  std::optional<std::filesystem::path> environmentMap = {};
  ViewRequest view;
  ClipRequest clip;
  int width = 512, height = 512;
  bool features = false; ///< marches the filter's features
  bool measure = false;  ///< measures the clip; traces the focus even if no clip needs it
  FocusRequest focusStyle = {};
  /// Degrees to both sides over which a clipping surface is steadied
  /// (clip/surface/SteadySurface.h).
  double steadyDegrees = 0.0;
  /// Modality that `transfer` was made for, if an organ preset chose it. A volume known to be of
  /// another modality gets the look that suits it, and a warning.
  std::optional<Modality> transferModality = {};
  /// Requested things that this request leaves out, with reasons: first of the scene's warnings.
  std::vector<std::string> omissions = {};
};

} // namespace fenestra
