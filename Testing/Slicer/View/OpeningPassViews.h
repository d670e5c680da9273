#pragma once
// Views of a volume that a pass opens, and the depths at which their rays start.

#include "ViewTest.h"
#include "vtkFenestraOpeningPass.h"

#include <vtkImageData.h>
#include <vtkMatrix4x4.h>
#include <vtkNew.h>
#include <vtkOpenGLGPUVolumeRayCastMapper.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>
#include <vtkVolume.h>
#include <vtkVolumeProperty.h>

#include <array>
#include <memory>
#include <string>
#include <vector>

namespace opening {

using views::Image;
using views::renderImage;

using fenestra::core::BoxCorners;
using fenestra::core::ClosedSurface;
using fenestra::core::LiveSurface;

/// Pass whose image is the axial depth at which each ray starts, before jittering.
class DepthPass : public vtkFenestraOpeningPass {
public:
  static DepthPass* New();
  vtkTypeMacro(DepthPass, vtkFenestraOpeningPass);
  bool PreReplaceShaderValues(std::string& vertexShader, std::string& geometryShader,
                              std::string& fragmentShader, vtkAbstractMapper* mapper,
                              vtkProp* prop) override;
};

/// A synthetic volume with anisotropic voxels, rotated and moved, and an ellipsoid in it.
struct Subject {
  Subject();

  vtkNew<vtkImageData> image;
  vtkNew<vtkMatrix4x4> toWorld;
  vtkNew<vtkVolumeProperty> property;
  BoxCorners box;
  std::shared_ptr<const ClosedSurface> focus;
  std::array<double, 3> center; ///< of the focus, mm
};

/// One volume in a renderer.
struct View {
  explicit View(const Subject& subject);
  /// Looks at the focus from a direction, at a distance in mm.
  void look(const Subject& subject, const std::array<double, 3>& direction, double distance,
            bool isPerspective);

  vtkNew<vtkRenderer> renderer;
  vtkNew<vtkOpenGLGPUVolumeRayCastMapper> mapper;
  vtkNew<vtkVolume> volume;
};

/// Depths in an image of DepthPass, mm; infinity: no ray.
std::vector<float> toDepths(const Image& image);

LiveSurface buildSurface(const Subject& subject, vtkRenderer* renderer);

/// Largest differences between measured and expected depths, mm.
struct Differences {
  double atFocus = 0.0, beside = 0.0;
  int focusPixels = 0, besidePixels = 0; ///< where the surface moves the start of the ray
};
/// `entries`: depths without an opening.
Differences compareDepths(const LiveSurface& surface, double offset, bool isCutaway, int width,
                          const std::vector<float>& entries, const std::vector<float>& depths);

} // namespace opening
