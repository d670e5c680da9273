#ifndef __vtkFenestraImageProp_h
#define __vtkFenestraImageProp_h

#include "FenestraViewCamera.h"
#include "FenestraViewImage.h"

#include <vtkNew.h>
#include <vtkOpenGLActor.h>
#include <vtkSmartPointer.h>
#include <vtkWeakPointer.h>

#include <array>
#include <memory>
#include <optional>

class vtkOpenGLRenderWindow;
class vtkPolyDataMapper;
class vtkShaderProgram;
class vtkTextureObject;

/// \brief Draws an image with depth over a complete 3D view.
///
/// Opaque pixels are drawn with opaque geometry, and others with translucent geometry, each at its
/// depth: models before and behind them are composed as with any surface, by depth peeling, too.
/// An image of another size than the view is stretched over it: colors are interpolated, and each
/// pixel has the depth of the nearest pixel of the image.
///
/// The image is visible while the renderer's camera is the image's, up to rounding. Otherwise the
/// prop is as if it were invisible: it is not drawn, it has no bounds and cannot be picked.
///
/// As an actor, it is a height field of the image, mm in world space: pickers such as
/// vtkCellPicker find its surface. Its bounds are those of all pixels with a depth.
class vtkFenestraImageProp : public vtkOpenGLActor {
public:
  static vtkFenestraImageProp* New();
  vtkTypeMacro(vtkFenestraImageProp, vtkOpenGLActor);

  /// Adds the prop to a renderer, and removes it from the one before. The image goes, too. Null:
  /// removes it only. The renderer keeps a reference to the prop.
  void SetRenderer(vtkRenderer* renderer);
  vtkRenderer* GetRenderer();

  /// Shows an image of the renderer's camera as it is now. Null: none. The clipping range is left
  /// as it is: callers reset it, as with any new prop. Depths beyond it are drawn at its ends.
  void SetImage(std::shared_ptr<const FenestraViewImage> image);
  /// Shows an image of a camera as it was, for images that come later than their camera.
  void SetImage(std::shared_ptr<const FenestraViewImage> image, const FenestraViewCamera& camera);

  /// Multiplies the alpha of all pixels, 0 to 1. Below 1, all pixels are translucent.
  void SetOpacity(double opacity);
  double GetOpacity() { return this->Opacity; }

  /// A point of the image's surface in world space, mm. Nothing: the image is not visible, or there
  /// is no depth.
  /// \param x, y position in the window, pixels from the lower left corner, as of vtkPicker. The
  ///   point is that of the center of the view's pixel there.
  std::optional<FenestraViewCamera::Point> FindPoint(double x, double y);

  /// Includes whether the renderer's camera is the image's.
  vtkTypeBool GetVisibility() override;
  vtkTypeBool HasOpaqueGeometry() override;
  vtkTypeBool HasTranslucentPolygonalGeometry() override;
  using vtkOpenGLActor::GetBounds;
  /// Null: there are no pixels with a depth, or the image is not visible.
  double* GetBounds() override;
  void Render(vtkRenderer* renderer, vtkMapper* mapper) override;
  void ReleaseGraphicsResources(vtkWindow* window) override;

protected:
  vtkFenestraImageProp();
  ~vtkFenestraImageProp() override;
  vtkFenestraImageProp(const vtkFenestraImageProp&) = delete;
  void operator=(const vtkFenestraImageProp&) = delete;

private:
  void Upload(vtkOpenGLRenderWindow* window);
  /// Called at every draw.
  void SetUniforms(vtkObject* mapper, unsigned long event, void* program);
  bool IsResized();

  vtkWeakPointer<vtkRenderer> Renderer;
  std::shared_ptr<const FenestraViewImage> Image;
  std::optional<FenestraViewCamera> Camera; ///< of the image
  double Opacity = 1.0;
  bool HasOpaquePixels = false, HasTranslucentPixels = false;
  std::array<double, 6> ImageBounds{};
  bool HasBounds = false;

  vtkNew<vtkPolyDataMapper> HeightFieldMapper; ///< of the actor, never drawn
  /// One per kind of geometry, since their shaders differ with depth peeling.
  vtkNew<vtkPolyDataMapper> OpaqueMapper, TranslucentMapper;
  vtkSmartPointer<vtkTextureObject> ColorTexture, DepthTexture;
  bool IsUploaded = false;
};

#endif
