#pragma once
// PreparedScene: everything that the integrators need, computed from a request in cached stages
// (scene/Stages.h). It is immutable; the scene of a changed request shares all stages whose
// arguments are equal.

#include "integrator/render/Render.h"
#include "scene/LungSegment.h"
#include "scene/SolidFocus.h"
#include "scene/TableRemoval.h"
#include "scene/VolumeSmoothing.h"

#include <tuple>

namespace fenestra::core {

/// Wall-clock seconds per stage, for the statistics; 0: the result was shared.
struct StageSeconds {
  double load = 0.0, smoothing = 0.0, materials = 0.0, classify = 0.0, focus = 0.0, spline = 0.0,
         fill = 0.0, features = 0.0;
};

/// Stages that were computed for a scene; false: shared with the previous scene.
struct UpdatedStages {
  bool volume = false, focus = false, transfer = false, camera = false, lights = false,
       clip = false, minMaxGrid = false, majorants = false, tint = false, labelWeights = false;

  bool operator==(const UpdatedStages&) const = default;
};

class PreparedScene {
public:
  /// Computes all stages. Throws Error.
  explicit PreparedScene(const RenderRequest& request);
  /// `input`: already opened from request.input. `stop` is polled between long stages; once true,
  /// throws Error (request, ErrorCode::stopped).
  PreparedScene(const RenderRequest& request, const Input& input,
                const StopFlag& stop = neverStopped);

  struct Focus {
    FocusHandle input;
    Grid volume;
    std::vector<Message> warnings; ///< of everything that was read for it
  };
  /// The focus of the request's scene, and the grid of its volume, without the other stages.
  /// Throws Error.
  static Focus readFocus(const RenderRequest& request, const Input& input);

  /// Returns the scene of another request. Recomputes only the stages that depend on a difference
  /// from this scene's request. Files are assumed not to change. `sameSize`: an earlier scene with
  /// the size of the request, or null; shares those stages that depend on the size. Throws Error.
  PreparedScene withRequest(const RenderRequest& request, const StopFlag& stop = neverStopped,
                            const PreparedScene* sameSize = nullptr) const;

  SceneView view() const {
    const TintOrMixture medium = tintOrMixture();
    return {volume(), transfer(),       *m_majorants, *m_lights,         *m_camera,
            clip(),   m_settings->crop, style(),      medium.tint.get(), medium.mixture.get()};
  }
  /// The volume that is rendered: as read, or smoothed.
  const Volume& volume() const { return currentVolume()->volume; }
  /// What smoothing did; nullopt: the request renders the volume as read.
  std::optional<SmoothingReport> smoothing() const;
  /// Bounding box of the volume, or its part inside a Slicer scene's crop box.
  Domain domain() const { return {volume().grid, m_settings->crop}; }
  /// Mask of the focus; null without one.
  const Mask* focus() const { return m_focus->mask ? &*m_focus->mask : nullptr; }
  /// Of the segmentation, mm (Segmentation::nativeSpacing); requires a focus or materials.
  Vec3 nativeSpacing() const { return allSegments()->segmentation.nativeSpacing(); }
  const TransferFunction& transfer() const { return m_transfer->function; }
  /// Source of the transfer function (TransferChoice::source).
  const std::string& transferName() const { return m_transfer->source; }
  const Camera& camera() const { return *m_camera; }
  const Clip& clip() const { return m_clip->clip; }
  /// Style of the context; null: unchanged.
  const ContextStyle* style() const { return m_style.result().get(); }
  /// Segment colors; null without materials.
  const Tint* tint() const { return currentTint().get(); }
  /// Media of the segments; null without materials, or if segments differ only in color.
  const Mixture* mixture() const { return m_mixture.result().get(); }
  /// Saturation of the context and the resulting contrast, which is empty with materials.
  const FocusContrast& contrast() const { return *m_contrast; }
  /// Contrast of a tinted focus; null if colors are not adjusted.
  const TintContrast* tintContrast() const { return m_tintContrast.result().get(); }
  /// Clip with its measures, and the depth of the focus.
  const ClipResult& clipResult() const { return *m_clip; }
  const MinMaxGrid& minMaxGrid() const { return *m_minMaxGrid; }
  /// Margins of the focus's segments; empty: not requested, or not CT.
  std::vector<SegmentMargin> margins() const {
    return m_trimmed.result() ? m_trimmed->margins : std::vector<SegmentMargin>();
  }
  /// Null unless the request includes features.
  const FeatureBuffers* features() const { return m_features.result().get(); }
  StageSeconds seconds() const;
  UpdatedStages updatedStages() const;
  std::vector<Message> warnings() const;
  /// What was chosen for transfer function, lights, labels and colors, one line each, such as
  /// "lights: cinema".
  std::vector<std::string> choices() const;
  /// Files read for the stages of this scene, including shared stages.
  std::vector<std::string> files() const;
  /// Background of a Slicer scene; empty for other inputs.
  const std::optional<Background>& background() const { return m_settings->background; }

private:
  struct Unprepared {};
  PreparedScene(const RenderRequest& request, const Input& input, Unprepared /*stages*/)
      : m_request(request), m_input(input) {}

  /// Computes all stages that m_request needs, in order.
  void prepare(const StopFlag& stop);
  /// The first of them: volume, settings and segments of the input, and lights. Adds found lungs to
  /// the request as its focus.
  void readInput();
  /// The stages after the input that the focus needs.
  void prepareFocus();
  /// Of readInput() and prepareFocus().
  std::vector<Message> inputWarnings() const;
  /// Name of the materials to use; `segments`: null without labels.
  std::string resolveMaterials(const Handle<SegmentsInput>& segments) const;
  void makeTint(const std::string& name, const StopFlag& stop);
  bool hasSolidFocus() const { return m_transparent.result() && !m_transparent->empty(); }
  InputChoice chooseSegmentation() const;
  /// Smooths the volume if the request says so. Returns currentVolume().
  VolumeHandle smooth(const StopFlag& stop);
  VolumeHandle currentVolume() const;
  VolumeHandle rawVolume() const; ///< without the table of the scanner, but not smoothed
  /// Segments as read or, in a request without any, found; null: none.
  const Handle<SegmentsInput>& allSegments() const {
    return m_lungs.result() && m_lungs->input ? m_lungs->input : m_segments.result();
  }
  /// Segments with their margins.
  Handle<SegmentsInput> currentSegments() const {
    return m_trimmed.result() ? m_trimmed->input : allSegments();
  }
  const Handle<Tint>& currentTint() const {
    return m_adjustedTint.result() ? m_adjustedTint.result() : m_tint.result();
  }
  TintOrMixture tintOrMixture() const {
    return m_mixture.result() ? TintOrMixture{nullptr, m_mixture.result()}
                              : TintOrMixture{currentTint(), nullptr};
  }
  template <typename Self>
  static auto stages(Self& s) {
    return std::tie(s.m_namedLights, s.m_namedTransfer, s.m_volumeChoice, s.m_volume, s.m_lungs,
                    s.m_table, s.m_withoutTable, s.m_settings, s.m_segments, s.m_trimmed, s.m_focus,
                    s.m_sceneTransfer, s.m_hasVoxels, s.m_content, s.m_transfer, s.m_smoothed,
                    s.m_islands, s.m_materials, s.m_skin, s.m_transparent, s.m_separated, s.m_plan,
                    s.m_labelWeights, s.m_tint, s.m_interfaces, s.m_tintContrast, s.m_adjustedTint,
                    s.m_mixture, s.m_focusWarnings, s.m_view, s.m_minMaxGrid, s.m_rawMinMaxGrid,
                    s.m_occupiedBounds, s.m_camera, s.m_lights, s.m_clip, s.m_contrast, s.m_style,
                    s.m_bounds, s.m_majorants, s.m_features);
  }

  RenderRequest m_request;
  Input m_input;
  CachedStage<&makeLights> m_namedLights;
  CachedStage<&findTransfer> m_namedTransfer; ///< unused without --transfer
  CachedStage<&Input::chooseForm> m_volumeChoice;
  CachedStage<&Input::volume> m_volume;
  CachedStage<&findLungSegment> m_lungs;    ///< unused unless needsLungs()
  CachedStage<&findTable> m_table;          ///< unused if the table stays
  CachedStage<&removeTable> m_withoutTable; ///< unused if there is no table
  CachedStage<&Input::settings> m_settings;
  CachedStage<&Input::segments> m_segments; ///< unused without a focus or materials
  CachedStage<&trimSegments> m_trimmed;     ///< unused without organ margins
  CachedStage<&makeFocus> m_focus;
  CachedStage<&Input::transfer> m_sceneTransfer; ///< unused with --transfer
  CachedStage<&findNonEmpty> m_hasVoxels;        ///< unused without segments
  CachedStage<&findContent> m_content;           ///< unused if the transfer function is given
  CachedStage<&chooseTransfer> m_transfer;
  CachedStage<&smoothVolume> m_smoothed; ///< this and the next: unused for the raw volume
  CachedStage<&dropIslands> m_islands;
  CachedStage<&findMaterials> m_materials; ///< this and the next four: unused without materials
  CachedStage<&findSkin> m_skin;           ///< unused unless the materials detect skin
  CachedStage<&findTransparentFocus> m_transparent; ///< unused with a given transfer function
  CachedStage<&separateSegments> m_separated;       ///< unused without a solid focus
  CachedStage<&makeTintPlan> m_plan;
  CachedStage<&computeLabelWeights> m_labelWeights;
  CachedStage<&buildTint> m_tint;
  CachedStage<&findTintInterfaces>
      m_interfaces; ///< this and the next two: unused unless colors are adjusted
  CachedStage<&adjustTintContrast> m_tintContrast;
  CachedStage<&adjustTint> m_adjustedTint;
  CachedStage<&makeMixture> m_mixture;      ///< unused if segments differ only in color
  CachedStage<&checkFocus> m_focusWarnings; ///< unused with a solid focus
  CachedStage<&chooseView> m_view;          ///< used only by automatic views
  CachedStage<&makeMinMaxGrid> m_minMaxGrid;
  CachedStage<&makeMinMaxGrid> m_rawMinMaxGrid; ///< used only for the bounds of a smoothed volume
  CachedStage<&findOccupiedBounds> m_occupiedBounds; ///< unused with the scene's camera
  CachedStage<&placeCamera> m_camera;
  CachedStage<&placeLights> m_lights;
  CachedStage<&buildClip> m_clip;
  CachedStage<&chooseContrast> m_contrast;
  CachedStage<&makeContextStyle> m_style; ///< unused if the context is unchanged
  CachedStage<&boundExtinction> m_bounds;
  CachedStage<&buildMajorants> m_majorants;
  CachedStage<&marchFirstHits> m_features; ///< unused without the denoiser
};

} // namespace fenestra::core
