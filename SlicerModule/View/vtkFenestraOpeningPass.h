#ifndef __vtkFenestraOpeningPass_h
#define __vtkFenestraOpeningPass_h

#include "clip/portable/LiveSurface.h"

#include <vtkOpenGLRenderPass.h>
#include <vtkSmartPointer.h>
#include <vtkWeakPointer.h>

#include <memory>
#include <optional>

class vtkOpenGLRenderWindow;
class vtkRenderer;
class vtkTextureObject;
class vtkVolume;

/// \brief Opens a volume by the clipping surface of the view's camera at every frame.
///
/// Listed in the volume's property keys, not in the renderer, so that it changes only the shader of
/// this volume's GPU ray caster in this renderer, and no shader property. One pass per renderer and
/// volume. The volume keeps a reference to the pass until it is detached.
///
/// Nothing is opened while a camera has an off-axis projection, a horizontal view angle or a user
/// transform. Volumes of vtkMultiVolume and other mappers are not opened.
class vtkFenestraOpeningPass : public vtkOpenGLRenderPass {
public:
  static vtkFenestraOpeningPass* New();
  vtkTypeMacro(vtkFenestraOpeningPass, vtkOpenGLRenderPass);

  /// Detaches first. The volume's deletion detaches, too.
  void Attach(vtkRenderer* renderer, vtkVolume* volume);
  /// The renderer and the volume may have been deleted.
  void Detach();
  vtkVolume* GetVolume();

  /// What is shown unoccluded, and the volume's box, mm in world space. Null: nothing is opened.
  void SetSubject(std::shared_ptr<const fenestra::core::ClosedSurface> focus,
                  const fenestra::core::BoxCorners& volume);

  enum Modes {
    Surface, ///< removes everything in front of the clipping surface
    Cutaway  ///< removes everything in front of the focus only
  };
  void SetMode(int mode);
  /// Moves the surface away from the camera, mm.
  void SetOffset(double mm);

  /// Number of surfaces computed.
  int GetUpdates() { return this->Updates; }
  /// Number of shader texts composed.
  int GetBuilds() { return this->Builds; }
  /// Duration of the computation of the last surface.
  double GetSeconds() { return this->Seconds; }

  /// Does nothing: the pass is not a renderer's.
  void Render(const vtkRenderState* state) override;
  bool PreReplaceShaderValues(std::string& vertexShader, std::string& geometryShader,
                              std::string& fragmentShader, vtkAbstractMapper* mapper,
                              vtkProp* prop) override;
  bool PostReplaceShaderValues(std::string& vertexShader, std::string& geometryShader,
                               std::string& fragmentShader, vtkAbstractMapper* mapper,
                               vtkProp* prop) override;
  bool SetShaderParameters(vtkShaderProgram* program, vtkAbstractMapper* mapper, vtkProp* prop,
                           vtkOpenGLVertexArrayObject* array = nullptr) override;
  /// Constant, since the text is: the mapper never rebuilds its shader for it.
  vtkMTimeType GetShaderStageMTime() override;

protected:
  vtkFenestraOpeningPass();
  ~vtkFenestraOpeningPass() override;
  vtkFenestraOpeningPass(const vtkFenestraOpeningPass&) = delete;
  void operator=(const vtkFenestraOpeningPass&) = delete;

private:
  /// Depths on the graphics device.
  struct DeviceMap {
    vtkSmartPointer<vtkTextureObject> Texture;
    float Window[4] = {0.0F, 0.0F, 0.0F, 0.0F}; ///< see FenestraOpeningShader.h

    void Upload(fenestra::core::DepthMap map, int filter, vtkOpenGLRenderWindow* window);
    bool IsIn(vtkOpenGLRenderWindow* window);
  };

  void OnStart();
  void OnEnd();
  /// False if there is no surface.
  bool Update(const fenestra::core::LiveCamera& camera, vtkOpenGLRenderWindow* window);

  vtkWeakPointer<vtkRenderer> Renderer;
  vtkWeakPointer<vtkVolume> Volume;
  unsigned long StartObserver = 0, EndObserver = 0, DeleteObserver = 0;

  std::shared_ptr<const fenestra::core::ClosedSurface> Focus;
  fenestra::core::BoxCorners Box{};
  int Mode = Surface;
  double Offset = 0.0;

  std::optional<fenestra::core::LiveCamera> Camera; ///< of the last surface
  DeviceMap FocusMap, FillMap;
  double TargetDepth = 0.0;
  bool HasSurface = false;
  bool IsOpen = false; ///< between the renderer's StartEvent and EndEvent only

  int Updates = 0, Builds = 0;
  double Seconds = 0.0;
};

#endif
