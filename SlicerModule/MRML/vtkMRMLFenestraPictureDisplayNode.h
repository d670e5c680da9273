#ifndef __vtkMRMLFenestraPictureDisplayNode_h
#define __vtkMRMLFenestraPictureDisplayNode_h

#include <vtkMRMLVectorVolumeDisplayNode.h>
#include <vtkNew.h>

#include "vtkSlicerFenestraModuleMRMLExport.h"

class vtkImageExtractComponents;

/// \brief Display of an RGBA image.
///
/// Slicer's display of vector volumes appends its own opacity to all components, and its slice
/// views do not accept an image of five components.
class VTK_SLICER_FENESTRA_MODULE_MRML_EXPORT vtkMRMLFenestraPictureDisplayNode
    : public vtkMRMLVectorVolumeDisplayNode {
public:
  static vtkMRMLFenestraPictureDisplayNode* New();
  vtkTypeMacro(vtkMRMLFenestraPictureDisplayNode, vtkMRMLVectorVolumeDisplayNode);

  vtkMRMLNode* CreateNodeInstance() override;
  const char* GetNodeTagName() override { return "FenestraPictureDisplay"; }
  vtkAlgorithmOutput* GetInputImageDataConnection() override;

protected:
  vtkMRMLFenestraPictureDisplayNode();
  ~vtkMRMLFenestraPictureDisplayNode() override;
  vtkMRMLFenestraPictureDisplayNode(const vtkMRMLFenestraPictureDisplayNode&) = delete;
  void operator=(const vtkMRMLFenestraPictureDisplayNode&) = delete;

  void SetInputToImageDataPipeline(vtkAlgorithmOutput* picture) override;

private:
  vtkNew<vtkImageExtractComponents> Colors, Opacity;
};

#endif
