// The layout that shows images, and points of a shown image in the anatomy.

#include "vtkSlicerFenestraLogic.h"

#include "FenestraImagePoint.h"
#include "vtkMRMLFenestraRenderNode.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <vtkImageData.h>
#include <vtkMRMLApplicationLogic.h>
#include <vtkMRMLCrosshairNode.h>
#include <vtkMRMLLayoutNode.h>
#include <vtkMRMLScene.h>
#include <vtkMRMLSelectionNode.h>
#include <vtkMRMLSliceCompositeNode.h>
#include <vtkMRMLSliceLogic.h>
#include <vtkMRMLSliceNode.h>
#include <vtkMRMLVolumeNode.h>
#include <vtkMatrix4x4.h>
#include <vtkNew.h>

namespace {
using Node = vtkMRMLFenestraRenderNode;

constexpr int ResultLayout = 5617; // larger than the numbers of Slicer's own layouts
constexpr const char* ResultLayoutXml =
    "<layout type=\"vertical\" split=\"true\"><item splitSize=\"680\">"
    "<layout type=\"horizontal\" split=\"true\">"
    "<item splitSize=\"500\"><view class=\"vtkMRMLSliceNode\" singletontag=\"Fenestra\">"
    "<property name=\"orientation\" action=\"default\">Axial</property>"
    "<property name=\"viewlabel\" action=\"default\">F</property>"
    "<property name=\"viewcolor\" action=\"default\">#6FB1C8</property></view></item>"
    "<item splitSize=\"500\"><view class=\"vtkMRMLViewNode\" singletontag=\"1\">"
    "<property name=\"viewlabel\" action=\"default\">1</property></view></item></layout></item>"
    "<item splitSize=\"320\"><layout type=\"horizontal\">"
    "<item><view class=\"vtkMRMLSliceNode\" singletontag=\"Red\">"
    "<property name=\"orientation\" action=\"default\">Axial</property>"
    "<property name=\"viewlabel\" action=\"default\">R</property>"
    "<property name=\"viewcolor\" action=\"default\">#F34A33</property></view></item>"
    "<item><view class=\"vtkMRMLSliceNode\" singletontag=\"Green\">"
    "<property name=\"orientation\" action=\"default\">Coronal</property>"
    "<property name=\"viewlabel\" action=\"default\">G</property>"
    "<property name=\"viewcolor\" action=\"default\">#6EB04B</property></view></item>"
    "<item><view class=\"vtkMRMLSliceNode\" singletontag=\"Yellow\">"
    "<property name=\"orientation\" action=\"default\">Sagittal</property>"
    "<property name=\"viewlabel\" action=\"default\">Y</property>"
    "<property name=\"viewcolor\" action=\"default\">#EDD54C</property></view></item>"
    "</layout></item></layout>";

/// Shows a frame in the slice view as the camera saw it. The image's j axis points down and k away
/// from the camera; the view's y axis points up and z to the viewer.
void AlignSliceWithFrame(vtkMRMLVolumeNode* picture, int frame, vtkMRMLSliceNode* slice) {
  double directions[3][3];
  picture->GetIJKToRASDirections(directions);
  vtkNew<vtkMatrix4x4> ijkToRas;
  picture->GetIJKToRASMatrix(ijkToRas);
  const int* size = picture->GetImageData()->GetDimensions();
  const double middle[4] = {0.5 * (size[0] - 1), 0.5 * (size[1] - 1), double(frame), 1.0};
  double center[4];
  ijkToRas->MultiplyPoint(middle, center);
  vtkNew<vtkMatrix4x4> toRas;
  for (int row = 0; row < 3; ++row) {
    toRas->SetElement(row, 0, directions[row][0]);
    toRas->SetElement(row, 1, -directions[row][1]);
    toRas->SetElement(row, 2, -directions[row][2]);
    toRas->SetElement(row, 3, center[row]);
  }
  slice->GetSliceToRAS()->DeepCopy(toRas);
  slice->UpdateMatrices();
}

/// Frame in the plane of the view; -1: none.
int FindFrame(vtkMRMLVolumeNode* picture, vtkMRMLSliceNode* slice) {
  vtkNew<vtkMatrix4x4> rasToIjk;
  picture->GetRASToIJKMatrix(rasToIjk);
  vtkMatrix4x4* plane = slice->GetSliceToRAS();
  const double origin[4] = {plane->GetElement(0, 3), plane->GetElement(1, 3),
                            plane->GetElement(2, 3), 1.0};
  double ijk[4];
  rasToIjk->MultiplyPoint(origin, ijk);
  const long frame = std::lround(ijk[2]);
  return frame >= 0 && frame < picture->GetImageData()->GetDimensions()[2] ? static_cast<int>(frame)
                                                                           : -1;
}

bool HasSize(vtkMRMLSliceNode* slice, const int* size) {
  return std::equal(size, size + 2, slice->GetDimensions());
}

vtkMRMLLayoutNode* FindLayoutNode(vtkMRMLScene* scene) {
  return !scene ? nullptr
                : vtkMRMLLayoutNode::SafeDownCast(scene->GetFirstNodeByClass("vtkMRMLLayoutNode"));
}

/// `picture`: node ID; null: none.
bool IsShowing(vtkMRMLSliceLogic* sliceLogic, const char* picture) {
  const char* shown = sliceLogic->GetSliceCompositeNode()->GetBackgroundVolumeID();
  return picture && shown && std::strcmp(picture, shown) == 0;
}

/// A point transformed by an affine matrix.
SlicerExport::Point Transform(vtkMatrix4x4* matrix, double x, double y, double z) {
  const double from[4] = {x, y, z, 1.0};
  double to[4];
  matrix->MultiplyPoint(from, to);
  return {to[0], to[1], to[2]};
}
} // namespace

void vtkSlicerFenestraLogic::OnMRMLSceneStartImport() {
  if (vtkMRMLLayoutNode* layout = FindLayoutNode(this->GetMRMLScene()))
    layout->AddLayoutDescription(ResultLayout, ResultLayoutXml);
}

/// The scene may have been saved with the layout.
void vtkSlicerFenestraLogic::OnMRMLSceneEndImport() {
  this->InvokeEvent(ViewChangedEvent);
}

void vtkSlicerFenestraLogic::ShowNewestVolume() {
  vtkMRMLApplicationLogic* application = this->GetMRMLApplicationLogic();
  vtkMRMLSelectionNode* selection = application ? application->GetSelectionNode() : nullptr;
  if (!this->GetMRMLScene())
    return;
  std::vector<vtkMRMLNode*> volumes;
  this->GetMRMLScene()->GetNodesByClass("vtkMRMLScalarVolumeNode", volumes);
  if (!selection || volumes.empty())
    return;
  selection->SetActiveVolumeID(volumes.back()->GetID());
  application->PropagateVolumeSelection();
}

vtkMRMLSliceLogic* vtkSlicerFenestraLogic::GetPictureSliceLogic() {
  auto* slice = vtkMRMLSliceNode::SafeDownCast(
      this->GetMRMLScene()->GetSingletonNode("Fenestra", "vtkMRMLSliceNode"));
  vtkMRMLApplicationLogic* application = this->GetMRMLApplicationLogic();
  return slice && application ? application->GetSliceLogic(slice) : nullptr;
}

void vtkSlicerFenestraLogic::ShowLayoutBefore() {
  if (vtkMRMLLayoutNode* layout = FindLayoutNode(this->GetMRMLScene()))
    layout->SetViewArrangement(this->PreviousLayout);
}

void vtkSlicerFenestraLogic::ShowResult(Node* render) {
  if (!render || !this->GetMRMLScene())
    return;
  auto* picture = vtkMRMLVolumeNode::SafeDownCast(render->GetNodeReference(Node::PictureRole));
  vtkMRMLLayoutNode* layout = FindLayoutNode(this->GetMRMLScene());
  if (!layout || GetNumberOfFrames(render) == 0)
    return;
  layout->AddLayoutDescription(ResultLayout, ResultLayoutXml);
  if (layout->GetViewArrangement() != ResultLayout)
    this->PreviousLayout = layout->GetViewArrangement();
  layout->SetViewArrangement(ResultLayout);

  vtkMRMLSliceLogic* sliceLogic = this->GetPictureSliceLogic();
  if (!sliceLogic)
    return;
  vtkMRMLSliceNode* slice = sliceLogic->GetSliceNode();
  vtkMRMLSliceCompositeNode* composite = sliceLogic->GetSliceCompositeNode();
  composite->SetBackgroundVolumeID(picture->GetID());
  composite->SetForegroundVolumeID(nullptr);
  composite->SetLabelVolumeID(nullptr);
  this->ShownFrame = this->FittedSize[0] = 0;
  AlignSliceWithFrame(picture, 0, slice);
  this->AlignView();
  vtkUnObserveMRMLNodeMacro(slice);
  vtkObserveMRMLNodeMacro(slice);
  this->InvokeEvent(ViewChangedEvent);
}

void vtkSlicerFenestraLogic::AlignView() {
  Node* render = this->GetShownRender();
  if (GetNumberOfFrames(render) == 0)
    return;
  vtkMRMLSliceLogic* sliceLogic = this->GetPictureSliceLogic();
  vtkMRMLSliceNode* slice = sliceLogic->GetSliceNode();
  auto* picture = vtkMRMLVolumeNode::SafeDownCast(render->GetNodeReference(Node::PictureRole));
  const int frame = FindFrame(picture, slice);
  if (!HasSize(slice, this->FittedSize)) {
    std::copy_n(slice->GetDimensions(), 2, this->FittedSize);
    sliceLogic->FitSliceToBackground(this->FittedSize[0], this->FittedSize[1]);
  }
  AlignSliceWithFrame(picture, frame < 0 ? this->ShownFrame : frame, slice);
}

void vtkSlicerFenestraLogic::OnMRMLNodeModified(vtkMRMLNode* node) {
  auto* slice = vtkMRMLSliceNode::SafeDownCast(node);
  Node* render = slice ? this->GetShownRender() : nullptr;
  if (GetNumberOfFrames(render) == 0)
    return;
  auto* picture = vtkMRMLVolumeNode::SafeDownCast(render->GetNodeReference(Node::PictureRole));
  if (!HasSize(slice, this->FittedSize) || FindFrame(picture, slice) < 0)
    this->InvokeEvent(ViewChangedEvent);
}

Node* vtkSlicerFenestraLogic::GetShownRender() {
  if (!this->GetMRMLScene())
    return nullptr;
  vtkMRMLLayoutNode* layout = FindLayoutNode(this->GetMRMLScene());
  vtkMRMLSliceLogic* sliceLogic = this->GetPictureSliceLogic();
  if (!sliceLogic || !layout || layout->GetViewArrangement() != ResultLayout)
    return nullptr;
  std::vector<vtkMRMLNode*> renders;
  this->GetMRMLScene()->GetNodesByClass("vtkMRMLFenestraRenderNode", renders);
  for (vtkMRMLNode* render : renders)
    if (IsShowing(sliceLogic, render->GetNodeReferenceID(Node::PictureRole)))
      return Node::SafeDownCast(render);
  return nullptr;
}

void vtkSlicerFenestraLogic::ShowFrame(Node* render, int frame) {
  if (!render || !this->GetMRMLScene())
    return;
  auto* picture = vtkMRMLVolumeNode::SafeDownCast(render->GetNodeReference(Node::PictureRole));
  if (!picture || frame < 0 || frame >= GetNumberOfFrames(render))
    return;
  vtkMRMLSliceLogic* sliceLogic = this->GetPictureSliceLogic();
  if (!sliceLogic || !IsShowing(sliceLogic, picture->GetID())) {
    this->ShowResult(render);
    sliceLogic = this->GetPictureSliceLogic(); // which the layout may have created just now
  }
  this->ShownFrame = frame;
  if (sliceLogic)
    AlignSliceWithFrame(picture, frame, sliceLogic->GetSliceNode());
}

bool vtkSlicerFenestraLogic::GetImagePoint(Node* render, double column, double row,
                                           double point[3]) {
  auto* depth =
      vtkMRMLVolumeNode::SafeDownCast(render ? render->GetNodeReference(Node::DepthRole) : nullptr);
  vtkImageData* image = depth ? depth->GetImageData() : nullptr;
  const char* text = depth ? depth->GetAttribute(Node::CameraAttribute) : nullptr;
  const auto camera = SlicerExport::parseImageCamera(text ? text : "");
  if (!image || !camera || !std::isfinite(column) || !std::isfinite(row))
    return false;
  const double i = std::floor(column + 0.5), j = std::floor(row + 0.5);
  const int* size = image->GetDimensions();
  if (i < 0.0 || j < 0.0 || i >= size[0] || j >= size[1])
    return false;
  const double z =
      image->GetScalarComponentAsDouble(static_cast<int>(i), static_cast<int>(j), 0, 0);
  if (!std::isfinite(z))
    return false;
  vtkNew<vtkMatrix4x4> toRas;
  depth->GetIJKToRASMatrix(toRas);
  const auto found = SlicerExport::findImagePoint(*camera, Transform(toRas, i, j, 0.0), z);
  std::copy(found.begin(), found.end(), point);
  return true;
}

bool vtkSlicerFenestraLogic::JumpSlicesToImagePoint(Node* render, double column, double row) {
  vtkMRMLScene* scene = this->GetMRMLScene();
  double point[3];
  if (!scene || !this->GetImagePoint(render, column, row, point))
    return false;
  vtkMRMLSliceLogic* shown = this->GetPictureSliceLogic();
  vtkMRMLSliceNode::JumpAllSlices(scene, point[0], point[1], point[2],
                                  vtkMRMLSliceNode::DefaultJumpSlice, -1,
                                  shown ? shown->GetSliceNode() : nullptr);
  auto* crosshair =
      vtkMRMLCrosshairNode::SafeDownCast(scene->GetFirstNodeByClass("vtkMRMLCrosshairNode"));
  if (crosshair)
    crosshair->SetCrosshairRAS(point);
  return true;
}

bool vtkSlicerFenestraLogic::JumpSlicesToViewPoint(double x, double y) {
  Node* render = this->GetShownRender();
  auto* picture = vtkMRMLVolumeNode::SafeDownCast(
      render ? render->GetNodeReference(Node::PictureRole) : nullptr);
  if (!picture)
    return false;
  const auto ras = Transform(this->GetPictureSliceLogic()->GetSliceNode()->GetXYToRAS(), x, y, 0.0);
  vtkNew<vtkMatrix4x4> toPixels;
  picture->GetRASToIJKMatrix(toPixels);
  const auto pixel = Transform(toPixels, ras[0], ras[1], ras[2]);
  return this->JumpSlicesToImagePoint(render, pixel[0], pixel[1]);
}
