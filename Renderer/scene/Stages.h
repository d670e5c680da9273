#pragma once
// Stages of a scene after its input: pure functions whose arguments are their keys (Stage.h).

#include "clip/surface/ClippingSurface.h"
#include "denoise/features/FeatureBuffers.h"
#include "metrics/BoundaryMetrics.h"
#include "model/lights/LightSet.h"
#include "scene/AutomaticView.h"
#include "scene/CachedStage.h"
#include "scene/Contrast.h"
#include "scene/Input.h"
#include "scene/NamedPresets.h"
#include "scene/SegmentTint.h"
#include "scene/TintContrast.h"

namespace fenestra {

struct FocusInput {
  std::optional<Mask> mask = {}; ///< nothing: no focus is requested
};

using SettingsHandle = Handle<SceneSettings>;
using FocusHandle = Handle<FocusInput>;
using VolumeHandle = Handle<VolumeInput>;
using TintInterfaces = std::vector<ComponentInterface>;

/// Lights of that name or JSON (findLights), with an environment or a map in place of their own
/// environments and skies.
NamedLights makeLights(const std::string& name, const std::optional<Rgb>& environment,
                       const std::optional<std::filesystem::path>& environmentMap);

/// Mask of the segments `names`, on the volume's grid; `segments`: null only without names.
FocusInput makeFocus(const Handle<SegmentsInput>& segments, const std::vector<std::string>& names,
                     const MaskShaping& shaping, const Grid& volume);

struct TransferChoice {
  TransferFunction function;
  std::string source; ///< source: a file, a preset, a node, or "by the volume's range"
  std::vector<std::string> warnings = {};
};
/// The transfer function `named` by the request, unless made for another modality than the
/// volume's, else the scene's, else one that suits the volume; then moved by `shift` and multiplied
/// by `density`. Throws Error (input) for a function that the volume cannot be rendered with.
TransferChoice chooseTransfer(const VolumeHandle& volume, const Handle<NamedTransfer>& named,
                              const Handle<SceneTransfer>& scene,
                              const std::optional<Modality>& madeFor, double shift, double density);

/// Warning of a focus that the look leaves mostly transparent.
std::vector<std::string> checkFocus(const VolumeHandle& volume, const FocusHandle& focus,
                                    const Handle<TransferChoice>& transfer);

/// Direction of the view that shows the focus best (AutomaticView.h).
ViewDirection chooseView(const VolumeHandle& volume, const SettingsHandle& settings,
                         const FocusHandle& focus, const Handle<TransferChoice>& transfer);

/// Box, in index space, of the cells that hold matter under the transfer function, before any clip.
Box findOccupiedBounds(const VolumeHandle& volume, const Handle<MinMaxGrid>& minMax,
                       const Handle<TransferChoice>& transfer);

/// `matter`: framed without a scene's camera; by value, so that a look that fills the same cells
/// keeps the camera. `best`: null unless the view is automatic.
Camera placeCamera(const ViewRequest& view, int width, int height, const VolumeHandle& volume,
                   const SettingsHandle& settings, const Box& bounds, const FocusHandle& focus,
                   const Handle<ViewDirection>& best);

/// Lights, and the camera and the focus for those in their frames.
struct FramedLights {
  Handle<NamedLights> lights;
  Handle<Camera> camera;
  FocusHandle focus;

  /// True also for different cameras or focuses if no light is in such a frame.
  bool operator==(const FramedLights& other) const;
};
/// Throws Error (input) for a light in the frame of a focus that there is not.
LightSet placeLights(const FramedLights& framed, const VolumeHandle& volume);

struct ClipResult {
  Clip clip = ClipNone();
  /// Depth of the focus at each pixel's centre, mm; infinity: missed. Empty without a focus, and,
  /// unless the clip is measured, in the clip modes none and plane (with a given plane).
  std::vector<double> focusDepth = {};
  /// mm by which the spline misses the focus's boundary, or an exact surface if measured; nothing
  /// in the other clip modes.
  std::optional<Distribution> mismatch = {};
  std::optional<BoundaryMetrics> boundary = {}; ///< nothing: not measured
  std::vector<ControlPoint> controlPoints = {}; ///< of a spline; empty for other clips
  std::vector<std::string> warnings = {};
  double focusSeconds = 0.0, splineSeconds = 0.0, fillSeconds = 0.0;
};
ClipResult buildClip(const ClipRequest& request, bool measure, double steadyDegrees,
                     const VolumeHandle& volume, const SettingsHandle& settings,
                     const FocusHandle& focus, const Handle<Camera>& camera);

/// `apron`: MajorantGrid::requiredPadding.
MinMaxGrid makeMinMaxGrid(const VolumeHandle& volume, int padding);

/// Skin without a segment: what lies within 2.5 mm of the air around the body (findOuterLayer()).
Mask findSkin(const VolumeHandle& volume);

/// Where the focus's components meet the others. `isFocus`: TintPlan's.
TintInterfaces findTintInterfaces(const VolumeHandle& volume, const FocusHandle& focus,
                                  const Handle<TransferChoice>& transfer,
                                  const Handle<LabelWeights>& weights,
                                  const std::vector<bool>& isFocus);

/// Knobs of the tint. `saturation`: of the request.
TintContrast adjustTintContrast(const Handle<TintInterfaces>& interfaces,
                                const Handle<TintPlan>& plan, const Handle<Tint>& tint,
                                const Handle<NamedMaterials>& materials,
                                const Handle<TransferChoice>& transfer,
                                const std::optional<double>& saturation);

/// Only where isTint() is false.
Mixture makeMixture(const Handle<TintPlan>& plan, const Handle<Tint>& tint,
                    const Handle<TransferChoice>& transfer);

Tint adjustTint(const Handle<Tint>& tint, const Handle<TintPlan>& plan,
                const Handle<TintContrast>& contrast, const Handle<TransferChoice>& transfer);

/// `saturation`: of the request. `tint`: null without materials; with them nothing is paled
/// unasked, and what contrast there is adjustTintContrast tells.
FocusContrast chooseContrast(const VolumeHandle& volume, const FocusHandle& focus,
                             const Handle<TransferChoice>& transfer, const Handle<Tint>& tint,
                             const std::optional<double>& saturation);

ContextStyle makeContextStyle(const FocusHandle& focus, double extinction, double saturation);

/// `style`: null if the context is unchanged; `mixture`: null if there is none.
MajorantGrid buildMajorants(const VolumeHandle& volume, const Handle<MinMaxGrid>& minMax,
                            const Handle<TransferChoice>& transfer, const Handle<ClipResult>& clip,
                            const Handle<ContextStyle>& style, const Handle<Mixture>& mixture);

/// Colours or matter of segments, as transport reads them; null: none.
struct TintOrMixture {
  Handle<Tint> tint;
  Handle<Mixture> mixture; ///< in place of a tint

  bool operator==(const TintOrMixture&) const = default;
};

/// Features of the filter. `style`: null if unused.
FeatureBuffers marchFirstHits(const VolumeHandle& volume, const SettingsHandle& settings,
                              const Handle<TransferChoice>& transfer, const TintOrMixture& segments,
                              const Handle<LightSet>& lights, const Handle<Camera>& camera,
                              const Handle<ClipResult>& clip, const Handle<ContextStyle>& style,
                              const Handle<MajorantGrid>& majorants);

} // namespace fenestra
