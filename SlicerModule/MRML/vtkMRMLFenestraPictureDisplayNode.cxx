#include "vtkMRMLFenestraPictureDisplayNode.h"

#include <vtkImageAppendComponents.h>
#include <vtkImageExtractComponents.h>
#include <vtkImageRGBToHSI.h>
#include <vtkImageShiftScale.h>
#include <vtkObjectFactory.h>

vtkMRMLNodeNewMacro(vtkMRMLFenestraPictureDisplayNode);

vtkMRMLFenestraPictureDisplayNode::vtkMRMLFenestraPictureDisplayNode() {
  this->Colours->SetComponents(0, 1, 2);
  this->Opacity->SetComponents(3);
  this->ShiftScale->SetInputConnection(this->Colours->GetOutputPort());
  this->RGBToHSI->SetInputConnection(this->Colours->GetOutputPort());
  this->AppendComponents->RemoveAllInputs();
  this->AppendComponents->AddInputConnection(0, this->ShiftScale->GetOutputPort());
  this->AppendComponents->AddInputConnection(0, this->Opacity->GetOutputPort());
}

vtkMRMLFenestraPictureDisplayNode::~vtkMRMLFenestraPictureDisplayNode() = default;

void vtkMRMLFenestraPictureDisplayNode::SetInputToImageDataPipeline(vtkAlgorithmOutput* picture) {
  this->Colours->SetInputConnection(picture);
  this->Opacity->SetInputConnection(picture);
}

vtkAlgorithmOutput* vtkMRMLFenestraPictureDisplayNode::GetInputImageDataConnection() {
  return this->Colours->GetNumberOfInputConnections(0) ? this->Colours->GetInputConnection(0, 0)
                                                       : nullptr;
}
