#ifndef __vtkSlicerModuleLogic_h
#define __vtkSlicerModuleLogic_h
// Stand-in for Slicer's class, to compile the wrapper's output for the module's logic.

#include <vtkObject.h>

class vtkMRMLNode;
class vtkMRMLScene;

class vtkSlicerModuleLogic : public vtkObject {
public:
  vtkTypeMacro(vtkSlicerModuleLogic, vtkObject);
  vtkMRMLScene* GetMRMLScene() { return nullptr; }

protected:
  virtual void RegisterNodes() {}
  virtual void SetMRMLSceneInternal(vtkMRMLScene*) {}
  virtual void OnMRMLSceneStartImport() {}
  virtual void OnMRMLSceneEndImport() {}
  virtual void OnMRMLSceneNodeAdded(vtkMRMLNode*) {}
  virtual void OnMRMLSceneNodeRemoved(vtkMRMLNode*) {}
  virtual void OnMRMLNodeModified(vtkMRMLNode*) {}
};

#endif
