#ifndef __vtkMRMLFenestraOpeningDisplayableManager_h
#define __vtkMRMLFenestraOpeningDisplayableManager_h

#include <vtkMRMLAbstractThreeDViewDisplayableManager.h>

#include <vtkNew.h>
#include <vtkWeakPointer.h>

#include "vtkSlicerFenestraModuleMRMLDisplayableManagerExport.h"

class vtkFenestraImageProp;
class vtkFenestraOpeningPass;
class vtkMRMLFenestraOpeningNode;
class vtkMRMLFenestraRenderNode;
class vtkVolume;

/// \brief Opens one 3D view: attaches the pass that cuts to the volume that the view's volume
/// rendering draws, with the focus and the mode of the scene's opened view. Draws the image of the
/// view, too, instead of that volume, while the camera is the image's.
///
/// The volume belongs to the volume rendering's displayable manager, which replaces it when its
/// display changes. It is therefore looked up before every frame.
class VTK_SLICER_FENESTRA_MODULE_MRMLDISPLAYABLEMANAGER_EXPORT
    vtkMRMLFenestraOpeningDisplayableManager : public vtkMRMLAbstractThreeDViewDisplayableManager {
public:
  static vtkMRMLFenestraOpeningDisplayableManager* New();
  vtkTypeMacro(vtkMRMLFenestraOpeningDisplayableManager,
               vtkMRMLAbstractThreeDViewDisplayableManager);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /// True if the view's next frame is cut.
  bool IsOpened();
  /// True if the view's next frame shows an image.
  bool IsImageShown();
  /// Duration of the computation of the last surface.
  double GetSeconds();

protected:
  vtkMRMLFenestraOpeningDisplayableManager();
  ~vtkMRMLFenestraOpeningDisplayableManager() override;
  vtkMRMLFenestraOpeningDisplayableManager(const vtkMRMLFenestraOpeningDisplayableManager&) =
      delete;
  void operator=(const vtkMRMLFenestraOpeningDisplayableManager&) = delete;

  void Create() override;
  void UnobserveMRMLScene() override;
  void OnMRMLSceneNodeAdded(vtkMRMLNode* node) override;
  void OnMRMLSceneNodeRemoved(vtkMRMLNode* node) override;
  void OnMRMLSceneEndBatchProcess() override;
  void ProcessMRMLNodesEvents(vtkObject* caller, unsigned long event, void* data) override;
  void UpdateFromMRML() override;

private:
  void Observe(vtkMRMLFenestraOpeningNode* opening);
  void RequestUpdate();
  bool AttachPass();
  void UpdateImage();
  void HideVolume();
  void OnStart();
  void OnEnd();
  vtkVolume* FindVolume();
  vtkVolume* FindVolumeToCut();

  vtkNew<vtkFenestraOpeningPass> Pass;
  vtkNew<vtkFenestraImageProp> Image;
  vtkWeakPointer<vtkVolume> Replaced; ///< by the image: cannot be picked
  vtkWeakPointer<vtkVolume> Hidden;   ///< between StartEvent and EndEvent: the image replaces it
  vtkMRMLFenestraOpeningNode* Opening = nullptr; ///< observed
  vtkMRMLFenestraRenderNode* Settings = nullptr; ///< observed
  unsigned long StartObserver = 0, EndObserver = 0;
};

#endif
