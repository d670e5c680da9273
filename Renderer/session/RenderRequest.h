#pragma once
// What a user asks for: plain data, filled by the command line (and whoever else drives a render).

#include "clip/surface/ClippingSurface.h"
#include "model/camera/Camera.h"
#include "model/masks/MaskShaping.h"
#include "model/volume/Modality.h"
#include "transport/render/Render.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace fenestra {

enum class ClipMode { none, plane, cutaway, surface, hole, ghost };

/// Those that are a depth buffer, and need a focus for it.
constexpr bool isDepthClip(ClipMode mode) {
  return mode != ClipMode::none && mode != ClipMode::plane;
}

struct PlaneRequest {
  Vec3 origin, normal; ///< RAS mm; what the normal points at is removed

  bool operator==(const PlaneRequest&) const = default;
};

struct ClipRequest {
  std::optional<ClipMode> mode = {}; ///< by default `surface` when there is a focus, else `none`
  std::optional<PlaneRequest> plane = {}; ///< by default the focus's own (FocusPlane.h)
  double ghost = 0.1; ///< share of the extinction left in front of the surface, in mode `ghost`
  /// A plane takes its offset and softness; `mode` decides its mode and its edge's ghost.
  SurfaceOptions surface = {};

  ClipMode modeWith(bool focus) const {
    return mode.value_or(focus ? ClipMode::surface : ClipMode::none);
  }

  bool operator==(const ClipRequest&) const = default;
};

/// How the focus's labels become its mask, and what the rest looks like.
struct FocusRequest {
  MaskShaping shaping = {};
  double contextExtinction = 1.0; ///< multiplies the extinction outside the focus, 0 to 1
  double contextSaturation = 1.0; ///< of the colours there, 0 to 1

  bool isStyled() const { return contextExtinction != 1.0 || contextSaturation != 1.0; }

  bool operator==(const FocusRequest&) const = default;
};

/// Where the eye is: a named direction, or a pose of which unset parts are derived from the scene.
struct ViewRequest {
  std::optional<Projection> projection = {}; ///< by default the scene's, else orthographic
  /// anterior, posterior, left, right, superior, inferior; auto: AutomaticView.h, with a focus
  std::optional<std::string> name = {};
  std::optional<Vec3> position = {}, target = {}, up = {};
  std::optional<double> scale = {}; ///< orthographic: half the viewport's height, mm
  std::optional<double> angle = {}; ///< perspective: full vertical angle, degrees

  /// The camera of a Slicer scene applies, with what else is set here changed.
  bool followsScene() const { return !name && !position; }
  bool isAutomatic() const { return name == "auto"; }

  bool operator==(const ViewRequest&) const = default;
};

struct SceneRequest {
  std::filesystem::path input;                  ///< a volume, a DICOM folder, or a Slicer scene
  std::optional<std::string> volume = {};       ///< which one of several: a node, or a DICOM series
  std::optional<std::string> segmentation = {}; ///< a node of the scene, or a file
  std::vector<std::string> focus = {};          ///< ids, names or label values
  std::optional<std::string> transfer =
      {}; ///< a file, or a preset's name; by default the scene's, else from the volume
  double shift = 0.0;
  double density = 1.0;
  std::string lights = "studio";       ///< a file, a preset's name, or the JSON itself
  std::optional<Rgb> environment = {}; ///< replaces the lights' own environment
  std::optional<std::filesystem::path> environmentMap = {};
  ViewRequest view;
  ClipRequest clip;
  int width = 512, height = 512;
  bool measure = false; ///< what the clip is worth: the focus is traced even where no clip needs it
  FocusRequest focusLook = {};
  /// A clipping surface is steadied over so many degrees to both sides
  /// (clip/surface/SteadySurface.h).
  double steadyDegrees = 0.0;
  /// What `transfer` was made for, where an organ preset chose it: a volume that is known to be
  /// something else gets the look that suits it, and a warning.
  std::optional<Modality> transferFor = {};
  /// What was asked for and is no part of this, and why: first of the scene's warnings.
  std::vector<std::string> leftOut = {};
};

} // namespace fenestra
