#pragma once
// From a request to everything that transport needs, in stages that each depend on the ones before:
// load, camera, lights, clip, classify. A picture that changes one thing redoes only what follows
// it.

#include "clipping/ClippingSurface.h"
#include "lights/LightSet.h"
#include "scene/RenderRequest.h"
#include "scene/SceneInput.h"

namespace fenestra {

/// Wall-clock seconds by stage, as the stats report them.
struct StageSeconds {
  double load = 0.0, classify = 0.0, focus = 0.0, spline = 0.0, fill = 0.0;
};

class Scene {
public:
  /// Reads files, places camera and lights, computes the clipping surface, classifies. Throws
  /// Error.
  explicit Scene(const SceneRequest& request);

  RenderScene forRender() const {
    return {m_volume, *m_transfer, *m_majorants, *m_lights, *m_camera, m_clip, m_crop};
  }
  const Volume& volume() const { return m_volume; }
  const TransferFunction& transfer() const { return *m_transfer; }
  /// Which transfer function it is: a file, a preset, or that it follows the volume's range.
  const std::string& look() const { return m_look; }
  const Camera& camera() const { return *m_camera; }
  const Clip& clip() const { return m_clip; }
  /// Depth of the focus at each pixel's centre, mm, infinity where it is missed; empty without a
  /// focus, and in the clip modes none and plane unless coverage is to be measured.
  const std::vector<double>& focusDepth() const { return m_focusDepth; }
  /// How far the spline misses the focus's boundary; nothing in the other clip modes.
  const std::optional<BoundaryMismatch>& mismatch() const { return m_mismatch; }
  const StageSeconds& seconds() const { return m_seconds; }
  const std::vector<std::string>& warnings() const { return m_warnings; }
  /// What a Slicer scene shows where no ray meets anything; nothing for other inputs.
  const std::optional<Background>& background() const { return m_background; }

private:
  void load(const SceneRequest& request);
  void chooseTransfer(const SceneRequest& request, const SceneInput& input);
  void placeCamera(const SceneRequest& request);
  void buildClip(const SceneRequest& request);
  void buildDepthClip(SurfaceMode mode, const ClipRequest& request);
  void classify();

  Domain domain() const { return {m_volume.grid, m_crop}; }

  Volume m_volume;
  std::optional<CropBox> m_crop;
  std::optional<CameraPose> m_sceneCamera;
  std::optional<Background> m_background;
  std::optional<Mask> m_focus;
  std::optional<TransferFunction> m_transfer;
  std::string m_look;
  std::optional<Camera> m_camera;
  std::optional<LightSet> m_lights;
  Clip m_clip;
  std::vector<double> m_focusDepth;
  std::optional<BoundaryMismatch> m_mismatch;
  std::optional<MajorantGrid> m_majorants;
  StageSeconds m_seconds;
  std::vector<std::string> m_warnings;
};

} // namespace fenestra
