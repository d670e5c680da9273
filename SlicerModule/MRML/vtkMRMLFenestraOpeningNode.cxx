#include "vtkMRMLFenestraOpeningNode.h"

#include "vtkMRMLFenestraRenderNode.h"

#include <vtkMRMLNodePropertyMacros.h>
#include <vtkObjectFactory.h>

vtkMRMLNodeNewMacro(vtkMRMLFenestraOpeningNode);

vtkMRMLFenestraOpeningNode::vtkMRMLFenestraOpeningNode() {
  this->AddNodeReferenceRole(SettingsRole);
}

vtkMRMLFenestraOpeningNode::~vtkMRMLFenestraOpeningNode() = default;

void vtkMRMLFenestraOpeningNode::ReadXMLAttributes(const char** atts) {
  const int wasModifying = this->StartModify();
  Superclass::ReadXMLAttributes(atts);
  vtkMRMLReadXMLBeginMacro(atts);
  vtkMRMLReadXMLBooleanMacro(visible, Visible);
  vtkMRMLReadXMLBooleanMacro(photorealistic, Photorealistic);
  vtkMRMLReadXMLEndMacro();
  this->EndModify(wasModifying);
}

void vtkMRMLFenestraOpeningNode::WriteXML(ostream& of, int indent) {
  Superclass::WriteXML(of, indent);
  vtkMRMLWriteXMLBeginMacro(of);
  vtkMRMLWriteXMLBooleanMacro(visible, Visible);
  vtkMRMLWriteXMLBooleanMacro(photorealistic, Photorealistic);
  vtkMRMLWriteXMLEndMacro();
}

void vtkMRMLFenestraOpeningNode::CopyContent(vtkMRMLNode* other, bool deep) {
  const int wasModifying = this->StartModify();
  Superclass::CopyContent(other, deep);
  // Focus and image are made again.
  if (auto* opening = vtkMRMLFenestraOpeningNode::SafeDownCast(other)) {
    this->SetVisible(opening->GetVisible());
    this->SetPhotorealistic(opening->GetPhotorealistic());
  }
  this->EndModify(wasModifying);
}

void vtkMRMLFenestraOpeningNode::PrintSelf(ostream& os, vtkIndent indent) {
  Superclass::PrintSelf(os, indent);
  vtkMRMLPrintBeginMacro(os, indent);
  vtkMRMLPrintBooleanMacro(Visible);
  vtkMRMLPrintBooleanMacro(Photorealistic);
  vtkMRMLPrintStdStringMacro(Problem);
  vtkMRMLPrintEndMacro();
}

vtkMRMLFenestraRenderNode* vtkMRMLFenestraOpeningNode::GetSettings() {
  return vtkMRMLFenestraRenderNode::SafeDownCast(this->GetNodeReference(SettingsRole));
}

bool vtkMRMLFenestraOpeningNode::HasFocus() const {
  return this->Triangles != nullptr;
}

bool vtkMRMLFenestraOpeningNode::HasImage() const {
  return this->Image.image != nullptr;
}

void vtkMRMLFenestraOpeningNode::SetImage(const ViewImage& image) {
  if (this->Image.image == image.image)
    return;
  this->Image = image;
  this->Modified();
}

void vtkMRMLFenestraOpeningNode::SetProblem(const std::string& problem) {
  if (this->Problem == problem)
    return;
  this->Problem = problem;
  this->Modified();
}

void vtkMRMLFenestraOpeningNode::SetFocus(const Focus& focus,
                                          const fenestra::core::BoxCorners& volume) {
  if (this->Triangles == focus && this->VolumeCorners == volume)
    return;
  this->Triangles = focus;
  this->VolumeCorners = volume;
  this->Modified();
}
