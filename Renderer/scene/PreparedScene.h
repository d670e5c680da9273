#pragma once
// Scene: everything that transport needs, made from a request in stages (scene/Stages.h). A scene
// is a value that never changes; the scene of another request shares all stages with equal keys.

#include "integrator/render/Render.h"
#include "scene/Stages.h"

#include <tuple>

namespace fenestra {

/// Wall-clock seconds by stage, for the stats; 0: shared.
struct StageSeconds {
  double load = 0.0, materials = 0.0, classify = 0.0, focus = 0.0, spline = 0.0, fill = 0.0,
         features = 0.0;
};

/// Stages made for a scene; false: shared with the scene before.
struct UpdatedStages {
  bool volume = false, focus = false, transfer = false, camera = false, lights = false,
       clip = false, minMaxGrid = false, majorants = false, tint = false, labelWeights = false;

  bool operator==(const UpdatedStages&) const = default;
};

class PreparedScene {
public:
  /// Makes all stages. Throws Error.
  explicit PreparedScene(const RenderRequest& request);
  /// `input`: of request.input, opened before.
  PreparedScene(const RenderRequest& request, const Input& input);

  /// Scene(request), of which only stages that depend on a difference from this scene's request are
  /// made. Files are assumed unchanged. Throws Error.
  PreparedScene withRequest(const RenderRequest& request) const;

  SceneView view() const {
    const TintOrMixture medium = tintOrMixture();
    return {volume(), transfer(),       *m_majorants, *m_lights,         *m_camera,
            clip(),   m_settings->crop, style(),      medium.tint.get(), medium.mixture.get()};
  }
  const Volume& volume() const { return m_volume->volume; }
  /// Volume's box, or its part inside a Slicer scene's cropping box.
  Domain domain() const { return {volume().grid, m_settings->crop}; }
  /// Mask of the focus; null: none.
  const Mask* focus() const { return m_focus->mask ? &*m_focus->mask : nullptr; }
  const TransferFunction& transfer() const { return m_transfer->function; }
  /// Source of the transfer function (Look::name).
  const std::string& transferName() const { return m_transfer->source; }
  const Camera& camera() const { return *m_camera; }
  const Clip& clip() const { return m_clip->clip; }
  /// Style of the context; null: unchanged.
  const ContextStyle* style() const { return m_style.result().get(); }
  /// Colours of the segments; null: no materials.
  const Tint* tint() const { return currentTint().get(); }
  /// Matter of the segments; null: they differ in colour alone, or there are no materials.
  const Mixture* mixture() const { return m_mixture.result().get(); }
  /// Saturation of the context, and the contrast that it leaves; none told with materials.
  const FocusContrast& contrast() const { return *m_contrast; }
  /// Contrast of a tinted focus; null: nothing sets it off.
  const TintContrast* tintContrast() const { return m_tintContrast.result().get(); }
  /// Clip with its measures, and the depth of the focus.
  const ClipResult& clipResult() const { return *m_clip; }
  const MinMaxGrid& minMaxGrid() const { return *m_minMaxGrid; }
  /// Null unless the request asks for features.
  const FeatureBuffers* features() const { return m_features.result().get(); }
  StageSeconds seconds() const;
  UpdatedStages updatedStages() const;
  std::vector<std::string> warnings() const;
  /// Look, light and labels in a line: what was chosen where the request left it open, and where
  /// from.
  std::string choices() const;
  /// Files read for the stages of this scene, shared stages included.
  std::vector<std::string> files() const;
  /// Background of a Slicer scene, where rays meet nothing; nothing for other inputs.
  const std::optional<Background>& background() const { return m_settings->background; }

private:
  /// Makes all stages that m_request needs, in their order.
  void prepare();
  /// Name of the materials; `segments`: null without labels.
  std::string resolveMaterials(const Handle<SegmentsInput>& segments) const;
  void makeTint(const std::string& name);
  const Handle<Tint>& currentTint() const {
    return m_contrastedTint.result() ? m_contrastedTint.result() : m_tint.result();
  }
  TintOrMixture tintOrMixture() const {
    return m_mixture.result() ? TintOrMixture{nullptr, m_mixture.result()}
                              : TintOrMixture{currentTint(), nullptr};
  }
  template <typename Self>
  static auto stages(Self& s) {
    return std::tie(s.m_namedLights, s.m_namedTransfer, s.m_volume, s.m_settings, s.m_segments,
                    s.m_focus, s.m_sceneTransfer, s.m_transfer, s.m_materials, s.m_hasVoxels,
                    s.m_skin, s.m_plan, s.m_labelWeights, s.m_tint, s.m_interfaces,
                    s.m_tintContrast, s.m_contrastedTint, s.m_mixture, s.m_focusWarnings, s.m_view,
                    s.m_minMaxGrid, s.m_occupiedBounds, s.m_camera, s.m_lights, s.m_clip,
                    s.m_contrast, s.m_style, s.m_majorants, s.m_features);
  }

  RenderRequest m_request;
  Input m_input;
  CachedStage<&makeLights> m_namedLights;
  CachedStage<&findTransfer> m_namedTransfer; ///< unused without --transfer
  CachedStage<&Input::volume> m_volume;
  CachedStage<&Input::settings> m_settings;
  CachedStage<&Input::segments> m_segments; ///< unused without a focus and materials
  CachedStage<&makeFocus> m_focus;
  CachedStage<&Input::transfer> m_sceneTransfer; ///< unused with --transfer
  CachedStage<&chooseTransfer> m_transfer;
  CachedStage<&findMaterials> m_materials; ///< this and the next five: unused without materials
  CachedStage<&findNonEmpty> m_hasVoxels;
  CachedStage<&findSkin> m_skin; ///< unused unless materials find skin
  CachedStage<&makeTintPlan> m_plan;
  CachedStage<&computeLabelWeights> m_labelWeights;
  CachedStage<&buildTint> m_tint;
  CachedStage<&findTintInterfaces>
      m_interfaces; ///< this and the next two: unused unless materials set off a focus
  CachedStage<&adjustTintContrast> m_tintContrast;
  CachedStage<&adjustTint> m_contrastedTint;
  CachedStage<&makeMixture> m_mixture; ///< unused where segments differ in colour alone
  CachedStage<&checkFocus> m_focusWarnings;
  CachedStage<&chooseView> m_view; ///< used by automatic views alone
  CachedStage<&makeMinMaxGrid> m_minMaxGrid;
  CachedStage<&findOccupiedBounds> m_occupiedBounds; ///< unused where the scene's camera applies
  CachedStage<&placeCamera> m_camera;
  CachedStage<&placeLights> m_lights;
  CachedStage<&buildClip> m_clip;
  CachedStage<&chooseContrast> m_contrast;
  CachedStage<&makeContextStyle> m_style; ///< unused if the context is unchanged
  CachedStage<&buildMajorants> m_majorants;
  CachedStage<&marchFirstHits> m_features; ///< unused without a filter
};

} // namespace fenestra
