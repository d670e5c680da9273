#pragma once
// Scene: everything that transport needs, made from a request in stages, each depending on earlier
// stages: volume, focus, transfer function, camera, lights, clip, ranges of cells, majorants. A
// scene is a value that never changes; the scene of another request shares all stages that do not
// depend on the difference.

#include "clip/surface/ClippingSurface.h"
#include "clip/surface/FocusPlane.h"
#include "measure/BoundaryMeasures.h"
#include "model/lights/LightSet.h"
#include "session/AutomaticView.h"
#include "session/NamedLooks.h"
#include "session/RenderRequest.h"
#include "session/SceneInput.h"

namespace fenestra {

/// Wall-clock seconds by stage, for the stats; 0: shared.
struct StageSeconds {
  double load = 0.0, classify = 0.0, focus = 0.0, spline = 0.0, fill = 0.0;
};

/// Stages made for a scene; false: shared with the scene before.
struct StagesMade {
  bool volume = false, focus = false, transfer = false, camera = false, lights = false,
       clip = false, ranges = false, majorants = false;

  bool operator==(const StagesMade&) const = default;
};

class Scene {
public:
  /// Reads files, places camera and lights, computes the clipping surface, classifies. Throws
  /// Error.
  explicit Scene(const SceneRequest& request);

  /// Scene(request), of which only stages that depend on a difference from this scene's request are
  /// made. Files are assumed unchanged. Throws Error.
  Scene changed(const SceneRequest& request) const;

  RenderScene forRender() const {
    return {volume(),  *m_transfer, *m_majorants,    *m_lights,
            *m_camera, m_clip,      m_settings.crop, style()};
  }
  const Volume& volume() const { return m_volume->volume; }
  /// Volume's box, or its part inside a Slicer scene's cropping box.
  Domain domain() const { return {volume().grid, m_settings.crop}; }
  /// Mask of the focus; null: none.
  const Mask* focus() const { return m_focus ? &m_focus->mask : nullptr; }
  const TransferFunction& transfer() const { return *m_transfer; }
  /// Source of the transfer function: a file, a preset, a node, or "by the volume's range".
  const std::string& look() const { return m_look; }
  const Camera& camera() const { return *m_camera; }
  const Clip& clip() const { return m_clip; }
  /// Style of the context; null: unchanged.
  const ContextStyle* style() const { return m_style ? &*m_style : nullptr; }
  /// Depth of the focus at each pixel's centre, mm; infinity: missed. Empty without a focus, and,
  /// unless the clip is measured, in the clip modes none and plane (with a given plane).
  const std::vector<double>& focusDepth() const { return m_focusDepth; }
  /// mm by which the spline misses the focus's boundary, or an exact surface if measured; nothing
  /// in the other clip modes.
  const std::optional<BoundaryMismatch>& mismatch() const { return m_mismatch; }
  /// Measures of the clip along the focus's outline; nothing: not measured.
  const std::optional<BoundaryMeasures>& boundary() const { return m_boundary; }
  /// Control points of a spline; empty for other clips.
  const std::vector<ControlPoint>& controlPoints() const { return m_controlPoints; }
  const CellRanges& ranges() const { return *m_ranges; }
  const StageSeconds& seconds() const { return m_seconds; }
  const StagesMade& made() const { return m_made; }
  std::vector<std::string> warnings() const;
  /// Files read for the stages of this scene, shared stages included.
  std::vector<std::string> files() const;
  /// Background of a Slicer scene, where rays meet nothing; nothing for other inputs.
  const std::optional<Background>& background() const { return m_settings.background; }

private:
  /// `before`: request of the stages so far; null: none.
  void make(const SceneRequest& request, const SceneRequest* before);
  void readFocus(const SceneRequest& request);
  void chooseTransfer(const SceneRequest& request);
  void placeCamera(const SceneRequest& request);
  void buildClip(const SceneRequest& request);
  void styleContext(const FocusRequest& request);
  /// `depth`: of the focus, needed if the request names no plane.
  ClipPlane placedPlane(const ClipRequest& request, const std::optional<FocusDepth>& depth) const;
  void buildDepthClip(ClipMode mode, const SceneRequest& scene);

  SceneRequest m_request;
  std::shared_ptr<const VolumeInput> m_volume;
  SceneSettings m_settings;
  std::shared_ptr<const FocusInput> m_focus;
  std::optional<NamedTransfer> m_named; ///< named by the request
  std::optional<TransferFunction> m_transfer;
  std::string m_look;
  std::optional<ViewDirection> m_automaticView; ///< set on first use
  std::vector<std::string> m_lookWarnings;
  std::optional<Camera> m_camera;
  std::shared_ptr<const std::vector<Light>> m_lightList; ///< as read
  std::string m_lightFile;                               ///< empty: not from a file
  std::shared_ptr<const LightSet> m_lights;
  Clip m_clip;
  std::optional<ContextStyle> m_style;
  std::vector<double> m_focusDepth;
  std::optional<BoundaryMismatch> m_mismatch;
  std::optional<BoundaryMeasures> m_boundary;
  std::vector<ControlPoint> m_controlPoints;
  std::vector<std::string> m_clipWarnings;
  std::shared_ptr<const CellRanges> m_ranges;
  std::shared_ptr<const MajorantGrid> m_majorants;
  StageSeconds m_seconds;
  StagesMade m_made;
};

} // namespace fenestra
