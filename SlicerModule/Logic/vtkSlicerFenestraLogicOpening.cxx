// The opened view.

#include "vtkSlicerFenestraLogic.h"

#include "vtkMRMLFenestraOpeningNode.h"
#include "vtkMRMLFenestraRenderNode.h"

#include <vtkMRMLScalarVolumeNode.h>
#include <vtkMRMLScene.h>
#include <vtkMRMLSegmentationNode.h>
#include <vtkMRMLSelectionNode.h>
#include <vtkMRMLVolumeRenderingDisplayNode.h>
#include <vtkSlicerVolumeRenderingLogic.h>

#include <vtkMRMLApplicationLogic.h>

namespace {
using Node = vtkMRMLFenestraRenderNode;
using Opening = vtkMRMLFenestraOpeningNode;
vtkMRMLScalarVolumeNode* FindVolume(Node* settings) {
  return vtkMRMLScalarVolumeNode::SafeDownCast(settings->GetNodeReference(Node::VolumeRole));
}
} // namespace

bool vtkSlicerFenestraLogic::CanOpenView(Node* settings) {
  return settings && FindVolume(settings) && HasFocus(settings);
}

std::string vtkSlicerFenestraLogic::FindOpeningProblem(Node* settings) {
  if (!settings)
    return {};
  const std::string mode = settings->GetFlag("clip");
  if (!mode.empty() && mode != "auto" && mode != "surface" && mode != "cutaway")
    return "The 3D view is cut only by a smooth surface, or in front of the focus. Choose one of "
           "them under Clip.";
  vtkMRMLScalarVolumeNode* volume = FindVolume(settings);
  for (int i = 0; volume && i < volume->GetNumberOfDisplayNodes(); ++i) {
    auto* display = vtkMRMLVolumeRenderingDisplayNode::SafeDownCast(volume->GetNthDisplayNode(i));
    if (display && display->GetVisibility() &&
        !display->IsA("vtkMRMLGPURayCastVolumeRenderingDisplayNode"))
      return "The 3D view is cut only by GPU ray casting. Choose it in the Volume Rendering "
             "module.";
  }
  return {};
}

Opening* vtkSlicerFenestraLogic::GetOpening() {
  vtkMRMLScene* scene = this->GetMRMLScene();
  return scene ? Opening::SafeDownCast(scene->GetFirstNodeByClass("vtkMRMLFenestraOpeningNode"))
               : nullptr;
}

Opening* vtkSlicerFenestraLogic::OpenView(Node* settings, bool wait) {
  vtkMRMLScene* scene = this->GetMRMLScene();
  if (!scene || !CanOpenView(settings)) {
    vtkErrorMacro("OpenView: the settings have no volume, or no focus");
    return nullptr;
  }
  vtkMRMLScalarVolumeNode* volume = FindVolume(settings);
  auto* rendering =
      vtkSlicerVolumeRenderingLogic::SafeDownCast(this->GetModuleLogic("VolumeRendering"));
  vtkMRMLVolumeRenderingDisplayNode* display =
      rendering ? rendering->GetFirstVolumeRenderingDisplayNode(volume) : nullptr;
  if (rendering && !display)
    display = rendering->CreateDefaultVolumeRenderingNodes(volume);
  if (display)
    display->SetVisibility(1);
  Opening* opening = this->AddOpening(settings);
  if (!opening->GetProblem().empty())
    opening->SetVisible(false); // so that opening it again tries again
  opening->SetVisible(true);
  return wait ? this->WaitForCut() : opening;
}

/// The opened view, once it is cut; null: it cannot be, and the log says why.
Opening* vtkSlicerFenestraLogic::WaitForCut() {
  this->InvokeEvent(OpeningWaitEvent);
  Opening* opening = this->GetOpening();
  if (opening && opening->GetProblem().empty())
    return opening;
  vtkErrorMacro("OpenView: the view is not cut. " << (opening ? opening->GetProblem() : ""));
  return nullptr;
}

/// The opened view, once it has an image; null: it has none, and the log says so.
Opening* vtkSlicerFenestraLogic::WaitForImage() {
  this->InvokeEvent(OpeningWaitEvent);
  Opening* opening = this->GetOpening();
  if (opening && opening->HasImage())
    return opening;
  vtkErrorMacro("ShowPhotorealistic: no 3D view shows an image");
  return nullptr;
}

/// The scene's opened view, created if missing, with these settings.
Opening* vtkSlicerFenestraLogic::AddOpening(Node* settings) {
  Opening* opening = this->GetOpening();
  if (!opening)
    opening = Opening::SafeDownCast(
        this->GetMRMLScene()->AddNewNodeByClass("vtkMRMLFenestraOpeningNode", "Opened view"));
  opening->SetNodeReferenceID(Opening::SettingsRole, settings->GetID());
  return opening;
}

bool vtkSlicerFenestraLogic::CanShowPhotorealistic(Node* settings) {
  return settings && FindVolume(settings);
}

Opening* vtkSlicerFenestraLogic::ShowPhotorealistic(Node* settings, bool wait) {
  if (!this->GetMRMLScene() || !CanShowPhotorealistic(settings)) {
    vtkErrorMacro("ShowPhotorealistic: the settings have no volume");
    return nullptr;
  }
  Opening* opening = this->AddOpening(settings);
  if (wait)
    opening->SetPhotorealistic(false); // drops an image of other settings
  opening->SetPhotorealistic(true);
  return wait ? this->WaitForImage() : opening;
}

void vtkSlicerFenestraLogic::HidePhotorealistic() {
  if (Opening* opening = this->GetOpening())
    opening->SetPhotorealistic(false);
}

Opening* vtkSlicerFenestraLogic::OpenSegment(vtkMRMLSegmentationNode* segmentation,
                                             const std::string& segmentId, bool wait) {
  Node* settings = this->GetSettings();
  if (!settings || !segmentation) {
    vtkErrorMacro("OpenSegment: there is no segmentation");
    return nullptr;
  }
  const std::string role = vtkMRMLSegmentationNode::GetReferenceImageGeometryReferenceRole();
  const char* reference = segmentation->GetNodeReferenceID(role.c_str());
  const bool isOther = settings->GetNodeReference(Node::SegmentationRole) != segmentation;
  if (isOther && reference)
    settings->SetNodeReferenceID(Node::VolumeRole, reference);
  vtkMRMLApplicationLogic* application = this->GetMRMLApplicationLogic();
  vtkMRMLSelectionNode* selection = application ? application->GetSelectionNode() : nullptr;
  if (!FindVolume(settings) && (reference || selection))
    settings->SetNodeReferenceID(Node::VolumeRole,
                                 reference ? reference : selection->GetActiveVolumeID());
  settings->SetNodeReferenceID(Node::SegmentationRole, segmentation->GetID());
  settings->SetFocus(std::vector<std::string>{segmentId});
  return this->OpenView(settings, wait);
}

Opening* vtkSlicerFenestraLogic::OpenVolume(vtkMRMLScalarVolumeNode* volume) {
  Node* settings = this->GetSettings();
  if (!settings || !volume) {
    vtkErrorMacro("OpenVolume: there is no volume");
    return nullptr;
  }
  settings->SetNodeReferenceID(Node::VolumeRole, volume->GetID());
  return this->OpenView(settings);
}

void vtkSlicerFenestraLogic::CloseView() {
  if (Opening* opening = this->GetOpening())
    opening->SetVisible(false);
}

void vtkSlicerFenestraLogic::OnMRMLSceneNodeAdded(vtkMRMLNode* node) {
  if (Opening::SafeDownCast(node))
    this->InvokeEvent(OpeningChangedEvent);
}

void vtkSlicerFenestraLogic::OnMRMLSceneNodeRemoved(vtkMRMLNode* node) {
  if (Opening::SafeDownCast(node))
    this->InvokeEvent(OpeningChangedEvent);
  this->RemoveResults(Node::SafeDownCast(node));
}
