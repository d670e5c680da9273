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
  vtkMRMLReadXMLEndMacro();
  this->EndModify(wasModifying);
}

void vtkMRMLFenestraOpeningNode::WriteXML(ostream& of, int indent) {
  Superclass::WriteXML(of, indent);
  vtkMRMLWriteXMLBeginMacro(of);
  vtkMRMLWriteXMLBooleanMacro(visible, Visible);
  vtkMRMLWriteXMLEndMacro();
}

void vtkMRMLFenestraOpeningNode::CopyContent(vtkMRMLNode* other, bool deep) {
  const int wasModifying = this->StartModify();
  Superclass::CopyContent(other, deep);
  if (auto* opening = vtkMRMLFenestraOpeningNode::SafeDownCast(other)) // the focus is made again
    this->SetVisible(opening->GetVisible());
  this->EndModify(wasModifying);
}

void vtkMRMLFenestraOpeningNode::PrintSelf(ostream& os, vtkIndent indent) {
  Superclass::PrintSelf(os, indent);
  vtkMRMLPrintBeginMacro(os, indent);
  vtkMRMLPrintBooleanMacro(Visible);
  vtkMRMLPrintStdStringMacro(Problem);
  vtkMRMLPrintEndMacro();
}

vtkMRMLFenestraRenderNode* vtkMRMLFenestraOpeningNode::GetSettings() {
  return vtkMRMLFenestraRenderNode::SafeDownCast(this->GetNodeReference(SettingsRole));
}

bool vtkMRMLFenestraOpeningNode::HasFocus() const {
  return this->Triangles != nullptr;
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
