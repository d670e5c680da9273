#include "vtkMRMLFenestraOpeningDisplayableManager.h"

#include "vtkFenestraImageProp.h"
#include "vtkFenestraOpeningPass.h"
#include "vtkMRMLFenestraOpeningNode.h"
#include "vtkMRMLFenestraRenderNode.h"

#include <vtkMRMLScene.h>
#include <vtkMRMLViewNode.h>
#include <vtkMRMLVolumeNode.h>

#include <vtkCommand.h>
#include <vtkGPUVolumeRayCastMapper.h>
#include <vtkObjectFactory.h>
#include <vtkRenderer.h>
#include <vtkVolume.h>
#include <vtkVolumeCollection.h>

#include <cstdlib>

vtkStandardNewMacro(vtkMRMLFenestraOpeningDisplayableManager);

namespace {
using Manager = vtkMRMLFenestraOpeningDisplayableManager;
using Node = vtkMRMLFenestraRenderNode;
} // namespace

Manager::vtkMRMLFenestraOpeningDisplayableManager() = default;

Manager::~vtkMRMLFenestraOpeningDisplayableManager() {
  if (this->GetRenderer()) {
    this->GetRenderer()->RemoveObserver(this->StartObserver);
    this->GetRenderer()->RemoveObserver(this->EndObserver);
  }
  this->Observe(nullptr);
}

void Manager::PrintSelf(ostream& os, vtkIndent indent) {
  Superclass::PrintSelf(os, indent);
}

bool Manager::IsOpened() {
  return this->Pass->GetVolume() != nullptr;
}

bool Manager::IsImageShown() {
  return this->Image->GetRenderer() && this->Image->GetVisibility();
}

double Manager::GetSeconds() {
  return this->Pass->GetSeconds();
}

void Manager::Create() {
  Superclass::Create();
  constexpr float beforeOthers = 1.0f;
  this->StartObserver = this->GetRenderer()->AddObserver(vtkCommand::StartEvent, this,
                                                         &Manager::OnStart, beforeOthers);
  this->EndObserver = this->GetRenderer()->AddObserver(vtkCommand::EndEvent, this, &Manager::OnEnd);
  this->UpdateFromMRML();
}

void Manager::UnobserveMRMLScene() {
  Superclass::UnobserveMRMLScene();
  this->Observe(nullptr);
  this->Pass->Detach();
  this->Image->SetRenderer(nullptr);
  this->HideVolume();
}

void Manager::OnMRMLSceneNodeAdded(vtkMRMLNode* node) {
  if (vtkMRMLFenestraOpeningNode::SafeDownCast(node) && !this->GetMRMLScene()->IsBatchProcessing())
    this->RequestUpdate();
}

void Manager::OnMRMLSceneNodeRemoved(vtkMRMLNode* node) {
  if (node == this->Opening)
    this->RequestUpdate();
}

/// After imports, closing, restored scene views and batches of scripts.
void Manager::OnMRMLSceneEndBatchProcess() {
  this->RequestUpdate();
}

void Manager::ProcessMRMLNodesEvents(vtkObject* caller, unsigned long event, void* data) {
  if (caller && (caller == this->Opening || caller == this->Settings))
    this->RequestUpdate();
  else
    Superclass::ProcessMRMLNodesEvents(caller, event, data);
}

void Manager::RequestUpdate() {
  this->SetUpdateFromMRMLRequested(true);
  this->RequestRender(); // calls UpdateFromMRML
}

/// Observes the opened view and its settings instead of those before.
void Manager::Observe(vtkMRMLFenestraOpeningNode* opening) {
  Node* settings = opening ? opening->GetSettings() : nullptr;
  if (this->Opening != opening) {
    vtkSetAndObserveMRMLNodeMacro(this->Opening, opening);
  }
  if (this->Settings != settings) {
    vtkSetAndObserveMRMLNodeMacro(this->Settings, settings);
  }
}

void Manager::UpdateFromMRML() {
  vtkMRMLScene* scene = this->GetMRMLScene();
  this->Observe(scene ? vtkMRMLFenestraOpeningNode::SafeDownCast(
                            scene->GetFirstNodeByClass("vtkMRMLFenestraOpeningNode"))
                      : nullptr);
  if (this->Settings) {
    const bool isCutaway = this->Settings->GetFlag("clip") == "cutaway";
    this->Pass->SetMode(isCutaway ? vtkFenestraOpeningPass::Cutaway
                                  : vtkFenestraOpeningPass::Surface);
    this->Pass->SetOffset(std::strtod(this->Settings->GetFlag("offset").c_str(), nullptr));
    this->Pass->SetSubject(this->Opening->GetFocus(), this->Opening->GetVolumeCorners());
  }
  this->AttachPass();
  this->UpdateImage();
}

/// Gives the image to the renderer of its view.
void Manager::UpdateImage() {
  vtkMRMLViewNode* view = this->GetMRMLViewNode();
  const bool isOn = this->Settings && this->Opening->GetPhotorealistic() &&
                    this->Opening->HasImage() && view && view->GetID() &&
                    this->Opening->GetImage().viewID == view->GetID();
  if (isOn != (this->Image->GetRenderer() != nullptr))
    this->Image->SetRenderer(isOn ? this->GetRenderer() : nullptr);
  if (isOn)
    this->Image->SetImage(this->Opening->GetImage().image, this->Opening->GetImage().camera);
  if (this->IsImageShown()) // else what lies outside the range is culled
    this->GetRenderer()->ResetCameraClippingRange();
}

vtkVolume* Manager::FindVolumeToCut() {
  const bool isCut = this->Settings && this->Opening->GetVisible() && this->Opening->HasFocus() &&
                     this->Opening->GetProblem().empty();
  return isCut ? this->FindVolume() : nullptr;
}

/// The settings' volume as it is rendered here; null: it is not. The volume rendering's displayable
/// manager has a function for it, but that logs an error if there is none.
vtkVolume* Manager::FindVolume() {
  auto* node = vtkMRMLVolumeNode::SafeDownCast(this->Settings->GetNodeReference(Node::VolumeRole));
  vtkAlgorithmOutput* image = node ? node->GetImageDataConnection() : nullptr;
  vtkVolumeCollection* volumes = this->GetRenderer()->GetVolumes();
  vtkCollectionSimpleIterator at;
  volumes->InitTraversal(at);
  while (vtkVolume* volume = volumes->GetNextVolume(at))
    if (auto* mapper = vtkGPUVolumeRayCastMapper::SafeDownCast(volume->GetMapper());
        mapper && image && mapper->GetInputConnection(0, 0) == image)
      return volume;
  return nullptr;
}

/// Returns whether the volume is another one than before.
bool Manager::AttachPass() {
  vtkVolume* volume = this->FindVolumeToCut();
  if (volume == this->Pass->GetVolume())
    return false;
  if (volume)
    this->Pass->Attach(this->GetRenderer(), volume);
  else
    this->Pass->Detach();
  return true;
}

void Manager::OnStart() {
  if (this->AttachPass())
    this->RequestRender(); // the pass takes effect in the next frame
  this->HideVolume();
}

/// Hides the volume that the image replaces until the end of the frame, and from pickers until a
/// frame without the image.
void Manager::HideVolume() {
  vtkVolume* volume = this->IsImageShown() ? this->FindVolume() : nullptr;
  if (this->Replaced && this->Replaced != volume)
    this->Replaced->SetPickable(true);
  if (volume && volume != this->Replaced && !volume->GetPickable())
    return; // by somebody else's choice
  this->Replaced = volume;
  if (!volume)
    return;
  volume->SetPickable(false);
  if (volume->GetVisibility()) {
    volume->SetVisibility(false);
    this->Hidden = volume;
  }
}

void Manager::OnEnd() {
  if (this->Hidden)
    this->Hidden->SetVisibility(true);
  this->Hidden = nullptr;
}
