#ifndef __vtkMRMLVectorVolumeDisplayNode_h
#define __vtkMRMLVectorVolumeDisplayNode_h
// Stand-in for Slicer's class with its filter pipeline: colors are scaled by the window, then an
// opacity is appended.

#include "vtkMRMLNode.h"

#include <vtkImageAppendComponents.h>
#include <vtkImageData.h>
#include <vtkImageExtractComponents.h>
#include <vtkImageRGBToHSI.h>
#include <vtkImageShiftScale.h>
#include <vtkImageThreshold.h>
#include <vtkNew.h>
#include <vtkTrivialProducer.h>

class vtkMRMLVectorVolumeDisplayNode : public vtkMRMLNode {
public:
  static vtkMRMLVectorVolumeDisplayNode* New();
  vtkTypeMacro(vtkMRMLVectorVolumeDisplayNode, vtkMRMLNode);
  vtkMRMLNode* CreateNodeInstance() override { return vtkMRMLVectorVolumeDisplayNode::New(); }
  const char* GetNodeTagName() override { return "VectorVolumeDisplay"; }
  virtual vtkAlgorithmOutput* GetInputImageDataConnection() {
    return this->ShiftScale->GetInputConnection(0, 0);
  }

  /// Image as a slice view receives it, for scripts.
  vtkImageData* GetDisplayedImage(vtkImageData* picture) {
    vtkNew<vtkTrivialProducer> source;
    source->SetOutput(picture);
    this->SetInputToImageDataPipeline(source->GetOutputPort());
    this->AppendComponents->Update();
    return this->AppendComponents->GetOutput();
  }

protected:
  vtkMRMLVectorVolumeDisplayNode() {
    this->ShiftScale->SetOutputScalarTypeToUnsignedChar();
    this->ExtractIntensity->SetInputConnection(this->RGBToHSI->GetOutputPort());
    this->ExtractIntensity->SetComponents(2);
    this->Threshold->SetInputConnection(this->ExtractIntensity->GetOutputPort());
    this->Threshold->SetOutputScalarTypeToUnsignedChar();
    this->Threshold->SetInValue(255);
    this->AppendComponents->AddInputConnection(0, this->ShiftScale->GetOutputPort());
    this->AppendComponents->AddInputConnection(0, this->Threshold->GetOutputPort());
  }
  virtual void SetInputToImageDataPipeline(vtkAlgorithmOutput* connection) {
    this->ShiftScale->SetInputConnection(connection);
    this->RGBToHSI->SetInputConnection(connection);
  }

  vtkNew<vtkImageShiftScale> ShiftScale;
  vtkNew<vtkImageRGBToHSI> RGBToHSI;
  vtkNew<vtkImageExtractComponents> ExtractIntensity;
  vtkNew<vtkImageThreshold> Threshold;
  vtkNew<vtkImageAppendComponents> AppendComponents;
};

inline vtkStandardNewMacro(vtkMRMLVectorVolumeDisplayNode)

#endif
