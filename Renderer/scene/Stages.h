#pragma once
// Stages of a scene after its input: pure functions whose arguments are cache keys (CachedStage.h).

#include "base/Error.h"
#include "clip/surface/ClippingSurface.h"
#include "denoise/features/FeatureBuffers.h"
#include "metrics/BoundaryMetrics.h"
#include "model/lights/LightSet.h"
#include "scene/AutomaticView.h"
#include "scene/CachedStage.h"
#include "scene/Contrast.h"
#include "scene/DefaultTransfer.h"
#include "scene/Input.h"
#include "scene/NamedPresets.h"
#include "scene/SegmentTint.h"
#include "scene/TintContrast.h"

namespace fenestra::core {

struct FocusInput {
  std::optional<Mask> mask = {}; ///< empty: no focus requested
  std::vector<Message> warnings = {};
};

using SettingsHandle = Handle<SceneSettings>;
using FocusHandle = Handle<FocusInput>;
using TintInterfaces = std::vector<ComponentInterface>;

/// Lights by name or inline JSON (findLights). An environment color or map replaces their own
/// environment and sky lights.
NamedLights makeLights(const std::string& name, const std::optional<Rgb>& environment,
                       const std::optional<std::filesystem::path>& environmentMap);

/// Margin of a segment, as in OrganMargin.
struct SegmentMargin {
  std::string segment; ///< its name; for adjacent segments, several
  bool isApplied;
  double volume, mean, p95;
};
struct TrimmedSegments {
  Handle<SegmentsInput> input;        ///< with the margins; the given one if nothing is removed
  std::vector<SegmentMargin> margins; ///< in the order of the names
};
/// Removes what belongs to other tissue from the segments `names` (OrganMargin.h). Adjacent
/// segments are one organ: between true and false lumen, margins would open a gap. `hasVoxels`:
/// from findNonEmpty(). The volume must be CT. Throws Error (input) for unknown names.
TrimmedSegments trimSegments(const Handle<SegmentsInput>& segments,
                             const Handle<std::vector<bool>>& hasVoxels,
                             const std::vector<std::string>& names, const VolumeHandle& volume);

/// Mask of the segments `names` on the volume's grid; `segments` is null only if `names` is empty.
/// Warns of segments that had no voxel even before trimSegments(). `hasVoxels`: from
/// findNonEmpty().
FocusInput makeFocus(const Handle<SegmentsInput>& segments,
                     const Handle<std::vector<bool>>& hasVoxels,
                     const std::vector<std::string>& names, const MaskShaping& shaping,
                     const Grid& volume);

/// True if chooseTransfer() depends on the content of the scan.
bool needsContent(const VolumeHandle& volume, const Handle<NamedTransfer>& named,
                  const Handle<SceneTransfer>& scene, const std::optional<Modality>& modality);

ScanContent findContent(const VolumeHandle& volume, const Handle<SegmentsInput>& segments,
                        const Handle<std::vector<bool>>& hasVoxels,
                        const std::vector<std::string>& focus);

struct TransferChoice {
  TransferFunction function;
  std::string source; ///< a file, a preset, a node, or "by the volume's range"
  std::vector<Message> warnings = {};
  bool isByModality = false;          ///< a preset, chosen as a default
  std::optional<double> islands = {}; ///< TransferFile::islands
};
/// Chooses the transfer function: `named`, unless `modality` is not the volume's, else the
/// scene's, else a default for the volume and its `content` (null: no segments). Then shifts it by
/// `shift`, scales its extinction by `density`, and sets its kind of gradient. Throws Error (input)
/// if the volume cannot be rendered with it.
TransferChoice chooseTransfer(const VolumeHandle& volume, const Handle<NamedTransfer>& named,
                              const Handle<SceneTransfer>& scene,
                              const Handle<ScanContent>& content,
                              const std::optional<Modality>& modality, double shift, double density,
                              GradientKind gradient);

/// Greatest transparentFraction() of a visible focus.
inline constexpr double mostTransparent = 0.5;

/// Warns if the transfer function leaves most of the focus transparent.
std::vector<Message> checkFocus(const VolumeHandle& volume, const FocusHandle& focus,
                                const Handle<TransferChoice>& transfer);

/// Direction of the view that shows the focus best (AutomaticView.h).
ViewDirection chooseView(const VolumeHandle& volume, const SettingsHandle& settings,
                         const FocusHandle& focus, const Handle<TransferChoice>& transfer);

/// Box, in index space, of the cells with non-zero extinction before clipping.
Box findOccupiedBounds(const VolumeHandle& volume, const Handle<MinMaxGrid>& minMax,
                       const Handle<TransferChoice>& transfer);

/// `bounds`: the box to frame without a scene's camera. It is passed by value, so that the camera
/// stays cached if another transfer function occupies the same cells. `best`: null unless the view
/// is automatic.
Camera placeCamera(const ViewRequest& view, int width, int height, const VolumeHandle& volume,
                   const SettingsHandle& settings, const Box& bounds, const FocusHandle& focus,
                   const Handle<ViewDirection>& best);

/// Lights, with the camera and focus that define the frames of some lights.
struct FramedLights {
  Handle<NamedLights> lights;
  Handle<Camera> camera;
  FocusHandle focus;

  /// Compares camera and focus only if a light uses their frame.
  bool operator==(const FramedLights& other) const;
};
/// Throws Error (input) for a light in the frame of the focus if there is no focus.
LightSet placeLights(const FramedLights& framed, const VolumeHandle& volume);

struct ClipResult {
  Clip clip = ClipNone();
  /// Depth of the focus at each pixel center, mm; infinity: missed. Empty without a focus. Also
  /// empty in the clip modes none and plane (with a given plane), unless the clip is measured.
  std::vector<double> focusDepth = {};
  /// Distance between the surface and the focus depth on the focus boundary, mm. Set for a spline,
  /// and for an exact surface if measured.
  std::optional<Distribution> mismatch = {};
  std::optional<BoundaryMetrics> boundary = {}; ///< empty: not measured
  std::vector<ControlPoint> controlPoints = {}; ///< of a spline; empty for other clips
  std::vector<Message> warnings = {};
  double focusSeconds = 0.0, splineSeconds = 0.0, fillSeconds = 0.0;
};
ClipResult buildClip(const ClipRequest& request, bool measure, double steadyDegrees,
                     const VolumeHandle& volume, const SettingsHandle& settings,
                     const FocusHandle& focus, const Handle<Camera>& camera);

/// `padding`: from MajorantGrid::requiredPadding.
MinMaxGrid makeMinMaxGrid(const VolumeHandle& volume, int padding);

/// Detects skin without a segment: the layer within 2.5 mm of the air around the body
/// (findOuterLayer()).
Mask findSkin(const VolumeHandle& volume);

/// Interfaces between the focus's components and the others. `isFocus`: from TintPlan.
TintInterfaces findTintInterfaces(const VolumeHandle& volume, const FocusHandle& focus,
                                  const Handle<TransferChoice>& transfer,
                                  const Handle<LabelWeights>& weights,
                                  const std::vector<bool>& isFocus);

/// Color adjustment of the tint. `saturation`: of the request.
TintContrast adjustTintContrast(const Handle<TintInterfaces>& interfaces,
                                const Handle<TintPlan>& plan, const Handle<Tint>& tint,
                                const Handle<NamedMaterials>& materials,
                                const Handle<TransferChoice>& transfer);

/// Requires that isTintOnly() is false.
Mixture makeMixture(const Handle<TintPlan>& plan, const Handle<Tint>& tint,
                    const Handle<TransferChoice>& transfer);

Tint adjustTint(const Handle<Tint>& tint, const Handle<TintPlan>& plan,
                const Handle<TintContrast>& contrast, const Handle<TransferChoice>& transfer);

/// `saturation`: of the request. `tint`: null without materials. With materials, the result is 1:
/// adjustTintContrast adjusts the context's colors and reports the contrast.
FocusContrast chooseContrast(const VolumeHandle& volume, const FocusHandle& focus,
                             const Handle<TransferChoice>& transfer, const Handle<Tint>& tint,
                             const std::optional<double>& saturation);

ContextStyle makeContextStyle(const FocusHandle& focus, double extinction, double saturation);

/// `mixture`: null without one.
ExtinctionBounds boundExtinction(const VolumeHandle& volume, const Handle<MinMaxGrid>& minMax,
                                 const Handle<TransferChoice>& transfer,
                                 const Handle<Mixture>& mixture);

/// `style`: null if the context is unchanged.
MajorantGrid buildMajorants(const Handle<ExtinctionBounds>& bounds, const Handle<ClipResult>& clip,
                            const Handle<ContextStyle>& style);

/// Colors or media of the segments, as the integrators use them; null: none.
struct TintOrMixture {
  Handle<Tint> tint;
  Handle<Mixture> mixture; ///< replaces the tint

  bool operator==(const TintOrMixture&) const = default;
};

/// Feature buffers of the denoiser. `style`: null if the context is unchanged. Throws as
/// requireRunning, soon after the flag was set.
FeatureBuffers marchFirstHits(const VolumeHandle& volume, const SettingsHandle& settings,
                              const Handle<TransferChoice>& transfer, const TintOrMixture& segments,
                              const Handle<LightSet>& lights, const Handle<Camera>& camera,
                              const Handle<ClipResult>& clip, const Handle<ContextStyle>& style,
                              const Handle<MajorantGrid>& majorants, FeatureEffort effort,
                              const StageStop& stop);

} // namespace fenestra::core
