#pragma once
// From a request to everything that transport needs, in stages that each depend on those before:
// volume, focus, transfer function, camera, lights, clip, ranges of cells, majorants. A scene is a
// value that never changes; another request makes a scene that shares with it whatever does not
// depend on what is different.

#include "clip/surface/ClippingSurface.h"
#include "clip/surface/FocusPlane.h"
#include "measure/BoundaryMeasures.h"
#include "model/lights/LightSet.h"
#include "session/AutomaticView.h"
#include "session/NamedLooks.h"
#include "session/RenderRequest.h"
#include "session/SceneInput.h"

namespace fenestra {

/// Wall-clock seconds by stage, as the stats report them; 0 for stages that were shared.
struct StageSeconds {
  double load = 0.0, classify = 0.0, focus = 0.0, spline = 0.0, fill = 0.0;
};

/// The stages that were made for a scene, and not shared with the one before.
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

  /// What Scene(request) would be, but only stages that depend on what differs from this scene's
  /// request are made. Files are taken not to have changed. Throws Error.
  Scene changed(const SceneRequest& request) const;

  RenderScene forRender() const {
    return {volume(),  *m_transfer, *m_majorants,    *m_lights,
            *m_camera, m_clip,      m_settings.crop, style()};
  }
  const Volume& volume() const { return m_volume->volume; }
  /// The volume's box, or what a Slicer scene's cropping box leaves of it.
  Domain domain() const { return {volume().grid, m_settings.crop}; }
  /// The mask of the focus; null where there is none.
  const Mask* focus() const { return m_focus ? &m_focus->mask : nullptr; }
  const TransferFunction& transfer() const { return *m_transfer; }
  /// Which transfer function it is: a file, a preset, or that it follows the volume's range.
  const std::string& look() const { return m_look; }
  const Camera& camera() const { return *m_camera; }
  const Clip& clip() const { return m_clip; }
  /// How what is not focus differs; null where it looks as it is.
  const ContextStyle* style() const { return m_style ? &*m_style : nullptr; }
  /// Depth of the focus at each pixel's centre, mm, infinity where it is missed; empty without a
  /// focus, and in the clip modes none and plane unless the clip is to be measured.
  const std::vector<double>& focusDepth() const { return m_focusDepth; }
  /// How far the spline misses the focus's boundary, or an exact surface where that is measured;
  /// nothing in the other clip modes.
  const std::optional<BoundaryMismatch>& mismatch() const { return m_mismatch; }
  /// How the context meets the focus's outline, where it is to be measured.
  const std::optional<BoundaryMeasures>& boundary() const { return m_boundary; }
  /// Of a spline; empty for other clips.
  const std::vector<ControlPoint>& controlPoints() const { return m_controlPoints; }
  const CellRanges& ranges() const { return *m_ranges; }
  const StageSeconds& seconds() const { return m_seconds; }
  const StagesMade& made() const { return m_made; }
  std::vector<std::string> warnings() const;
  /// Files that were read, for this scene or for those that it shares stages with.
  std::vector<std::string> files() const;
  /// What a Slicer scene shows where no ray meets anything; nothing for other inputs.
  const std::optional<Background>& background() const { return m_settings.background; }

private:
  /// `before`: the request that the stages so far were made for; null where there are none.
  void make(const SceneRequest& request, const SceneRequest* before);
  void readFocus(const SceneRequest& request);
  void chooseTransfer(const SceneRequest& request);
  void placeCamera(const SceneRequest& request);
  void buildClip(const SceneRequest& request);
  void styleContext(const FocusRequest& request);
  /// `depth` of the focus is needed where the request names no plane.
  ClipPlane placedPlane(const ClipRequest& request, const std::optional<FocusDepth>& depth) const;
  void buildDepthClip(ClipMode mode, const SceneRequest& scene);

  SceneRequest m_request;
  std::shared_ptr<const VolumeInput> m_volume;
  SceneSettings m_settings;
  std::shared_ptr<const FocusInput> m_focus;
  std::optional<NamedTransfer> m_named; ///< as the request names it
  std::optional<TransferFunction> m_transfer;
  std::string m_look;
  std::optional<ViewDirection> m_automaticView; ///< once it was asked for
  std::vector<std::string> m_lookWarnings;
  std::optional<Camera> m_camera;
  std::shared_ptr<const std::vector<Light>> m_lightList; ///< as they were read
  std::string m_lightFile;                               ///< empty where they are of no file
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
