#include "vtkMRMLFenestraPictureDisplayNode.h"

#include <vtkImageAppendComponents.h>
#include <vtkImageExtractComponents.h>
#include <vtkImageRGBToHSI.h>
#include <vtkImageShiftScale.h>
#include <vtkObjectFactory.h>

vtkMRMLNodeNewMacro(vtkMRMLFenestraPictureDisplayNode);

vtkMRMLFenestraPictureDisplayNode::vtkMRMLFenestraPictureDisplayNode() {
  this->Colors->SetComponents(0, 1, 2);
  this->Opacity->SetComponents(3);
  this->ShiftScale->SetInputConnection(this->Colors->GetOutputPort());
  this->RGBToHSI->SetInputConnection(this->Colors->GetOutputPort());
  this->AppendComponents->RemoveAllInputs();
  this->AppendComponents->AddInputConnection(0, this->ShiftScale->GetOutputPort());
  this->AppendComponents->AddInputConnection(0, this->Opacity->GetOutputPort());
}

vtkMRMLFenestraPictureDisplayNode::~vtkMRMLFenestraPictureDisplayNode() = default;

void vtkMRMLFenestraPictureDisplayNode::SetInputToImageDataPipeline(vtkAlgorithmOutput* picture) {
  this->Colors->SetInputConnection(picture);
  this->Opacity->SetInputConnection(picture);
}

vtkAlgorithmOutput* vtkMRMLFenestraPictureDisplayNode::GetInputImageDataConnection() {
  return this->Colors->GetNumberOfInputConnections(0) ? this->Colors->GetInputConnection(0, 0)
                                                      : nullptr;
}
