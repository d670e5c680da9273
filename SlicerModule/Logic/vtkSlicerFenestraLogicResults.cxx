#include "vtkSlicerFenestraLogic.h"

#include "vtkMRMLFenestraRenderNode.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <vtkImageData.h>
#include <vtkImageExtractComponents.h>
#include <vtkImageFlip.h>
#include <vtkMRMLApplicationLogic.h>
#include <vtkMRMLLayoutNode.h>
#include <vtkMRMLModelNode.h>
#include <vtkMRMLScalarVolumeDisplayNode.h>
#include <vtkMRMLScalarVolumeNode.h>
#include <vtkMRMLScene.h>
#include <vtkMRMLSelectionNode.h>
#include <vtkMRMLSliceCompositeNode.h>
#include <vtkMRMLSliceLogic.h>
#include <vtkMRMLSliceNode.h>
#include <vtkMRMLSubjectHierarchyNode.h>
#include <vtkMRMLVectorVolumeNode.h>
#include <vtkMRMLViewNode.h>
#include <vtkMatrix4x4.h>
#include <vtkNew.h>
#include <vtkPNGReader.h>
#include <vtkPolyData.h>
#include <vtkStringArray.h>
#include <vtkXMLPolyDataReader.h>

namespace {
using Node = vtkMRMLFenestraRenderNode;

constexpr const char* PictureViewId = "vtkMRMLSliceNodeFenestra"; // class and singleton tag
constexpr int ResultLayout = 5617; // larger than the numbers of Slicer's own layouts
constexpr const char* ResultLayoutXml =
    "<layout type=\"horizontal\" split=\"true\">"
    "<item splitSize=\"500\"><view class=\"vtkMRMLSliceNode\" singletontag=\"Fenestra\">"
    "<property name=\"orientation\" action=\"default\">Axial</property>"
    "<property name=\"viewlabel\" action=\"default\">F</property>"
    "<property name=\"viewcolor\" action=\"default\">#6FB1C8</property></view></item>"
    "<item splitSize=\"500\"><view class=\"vtkMRMLViewNode\" singletontag=\"1\">"
    "<property name=\"viewlabel\" action=\"default\">1</property></view></item></layout>";

vtkSmartPointer<vtkImageData> ToVtk(const SlicerExport::Image& image) {
  vtkNew<vtkImageData> copy;
  copy->SetDimensions(static_cast<int>(image.size[0]), static_cast<int>(image.size[1]),
                      static_cast<int>(image.size[2]));
  copy->AllocateScalars(VTK_FLOAT, static_cast<int>(image.components));
  std::memcpy(copy->GetScalarPointer(), image.data.get(), image.bytes());
  return copy;
}

SlicerExport::Image ReadFloatImage(const std::string& file) {
  SlicerExport::Image image = SlicerExport::readNrrd(file);
  if (image.type != "float" || image.size[2] != 1)
    throw SlicerExport::FileError(file + ": not an image written by Fenestra; render it again");
  return image;
}

bool IsOpaque(vtkImageData* picture) {
  const auto* pixels = static_cast<const unsigned char*>(picture->GetScalarPointer());
  for (vtkIdType i = 0; i < picture->GetNumberOfPoints(); ++i)
    if (pixels[4 * i + 3] != 255)
      return false;
  return true;
}

/// Reads image files as slices, with row 0 at the top, as in the renderer's volumes. Keeps the
/// fourth component only if a pixel is transparent.
vtkSmartPointer<vtkImageData> ReadPictures(const std::vector<std::string>& files) {
  vtkNew<vtkStringArray> names;
  for (const std::string& file : files)
    names->InsertNextValue(file);
  vtkNew<vtkPNGReader> reader;
  reader->SetFileNames(names);
  vtkNew<vtkImageFlip> flip;
  flip->SetInputConnection(reader->GetOutputPort());
  flip->SetFilteredAxis(1);
  vtkNew<vtkImageExtractComponents> colors;
  colors->SetInputConnection(flip->GetOutputPort());
  colors->SetComponents(0, 1, 2);
  flip->Update();
  vtkSmartPointer<vtkImageData> picture = flip->GetOutput();
  if (picture->GetNumberOfScalarComponents() == 4 &&
      picture->GetScalarType() == VTK_UNSIGNED_CHAR && !IsOpaque(picture))
    return picture;
  colors->Update();
  return colors->GetOutput();
}

std::string MakeFrameFileName(const std::string& folder, int frame) {
  std::string number = std::to_string(frame);
  number.insert(0, 4 - std::min<size_t>(4, number.size()), '0');
  return folder + "/frame_" + number + ".png";
}

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

/// Sets the display window to the range of the finite values.
void SetWindowToFiniteRange(vtkMRMLVolumeNode* volume, const SlicerExport::Image& depth) {
  auto* display = vtkMRMLScalarVolumeDisplayNode::SafeDownCast(volume->GetDisplayNode());
  const auto* values = static_cast<const float*>(depth.data.get());
  double least = std::numeric_limits<double>::infinity(), greatest = -least;
  for (size_t i = 0; i < depth.bytes() / sizeof(float); ++i)
    if (std::isfinite(values[i])) {
      least = std::min<double>(least, values[i]);
      greatest = std::max<double>(greatest, values[i]);
    }
  if (!display || !(least < greatest))
    return;
  display->AutoWindowLevelOff();
  display->SetWindowLevelMinMax(least, greatest);
}
} // namespace

void vtkSlicerFenestraLogic::OnMRMLSceneStartImport() {
  if (vtkMRMLLayoutNode* layout = FindLayoutNode(this->GetMRMLScene()))
    layout->AddLayoutDescription(ResultLayout, ResultLayoutXml);
}

std::vector<std::string> vtkSlicerFenestraLogic::GetFrameFiles(const std::string& folder) {
  std::vector<std::string> files;
  std::string next = MakeFrameFileName(folder, 0);
  std::error_code unreadable; // counts as missing
  while (std::filesystem::exists(next, unreadable)) {
    files.push_back(next);
    next = MakeFrameFileName(folder, static_cast<int>(files.size()));
  }
  return files;
}

FenestraResult vtkSlicerFenestraLogic::ReadResult(const std::string& folder) {
  FenestraResult result;
  const std::vector<std::string> frames = GetFrameFiles(folder);
  if (!frames.empty()) {
    result.picture = ReadPictures(frames);
    return result;
  }
  result.radiance = ReadFloatImage(folder + "/radiance.nrrd");
  result.depth = ReadFloatImage(folder + "/radiance-Z.nrrd");
  result.picture = ReadPictures({folder + "/picture.png"});
  const std::string surface = folder + "/surface.vtp";
  if (std::filesystem::exists(surface)) {
    vtkNew<vtkXMLPolyDataReader> reader;
    reader->SetFileName(surface.c_str());
    reader->Update();
    result.surface = reader->GetOutput();
  }
  return result;
}

/// Moves a result into the render's folder of the subject hierarchy, beside the render's volume.
void vtkSlicerFenestraLogic::MoveToRenderFolder(Node* render, vtkMRMLNode* result) {
  auto* hierarchy = vtkMRMLSubjectHierarchyNode::GetSubjectHierarchyNode(this->GetMRMLScene());
  if (!hierarchy)
    return;
  const vtkIdType none = vtkMRMLSubjectHierarchyNode::GetInvalidItemID();
  vtkIdType parent = hierarchy->GetSceneItemID();
  if (vtkMRMLNode* volume = render->GetNodeReference(Node::VolumeRole))
    if (const vtkIdType item = hierarchy->GetItemByDataNode(volume); item != none)
      parent = hierarchy->GetItemParent(item);
  vtkIdType folder = hierarchy->GetItemChildWithName(parent, render->GetName());
  if (folder == none)
    folder = hierarchy->CreateFolderItem(parent, render->GetName());
  if (const vtkIdType item = hierarchy->GetItemByDataNode(result); item != none)
    hierarchy->SetItemParent(item, folder);
  else
    hierarchy->CreateItem(folder, result);
}

/// Removes the results of a removed render, and their folder.
void vtkSlicerFenestraLogic::RemoveResults(Node* render) {
  vtkMRMLScene* scene = this->GetMRMLScene();
  if (!render || !scene || scene->IsClosing())
    return;
  auto* hierarchy = vtkMRMLSubjectHierarchyNode::GetSubjectHierarchyNode(scene);
  const vtkIdType none = vtkMRMLSubjectHierarchyNode::GetInvalidItemID();
  for (const char* role :
       {Node::PictureRole, Node::RadianceRole, Node::DepthRole, Node::SurfaceRole}) {
    const char* id = render->GetNodeReferenceID(role);
    vtkMRMLNode* result = id ? scene->GetNodeByID(id) : nullptr;
    if (!result)
      continue;
    const vtkIdType item = hierarchy ? hierarchy->GetItemByDataNode(result) : none;
    const vtkIdType folder = item != none ? hierarchy->GetItemParent(item) : none;
    scene->RemoveNode(result);
    if (folder != none && hierarchy->GetItemName(folder) == render->GetName() &&
        hierarchy->GetNumberOfItemChildren(folder) == 0)
      hierarchy->RemoveItem(folder);
  }
}

vtkMRMLVolumeNode* vtkSlicerFenestraLogic::AddVolume(Node* render, const char* className,
                                                     const char* role, vtkImageData* image,
                                                     const SlicerExport::Matrix& ijkToRas) {
  vtkMRMLScene* scene = this->GetMRMLScene();
  const std::string name = std::string(render->GetName()) + " " + role;
  auto* volume = vtkMRMLVolumeNode::SafeDownCast(
      scene->AddNewNodeByClass(className, scene->GenerateUniqueName(name.c_str())));
  vtkNew<vtkMatrix4x4> matrix;
  matrix->DeepCopy(ijkToRas.data());
  volume->SetIJKToRASMatrix(matrix);
  volume->SetAndObserveImageData(image);
  // A transparent picture; Slicer's own display node would ignore its opacity.
  if (image->GetNumberOfScalarComponents() == 4 && image->GetScalarType() == VTK_UNSIGNED_CHAR)
    volume->SetAndObserveDisplayNodeID(
        scene->AddNewNodeByClass("vtkMRMLFenestraPictureDisplayNode")->GetID());
  volume->CreateDefaultDisplayNodes();
  if (vtkMRMLDisplayNode* display = volume->GetDisplayNode())
    display->SetDisplayableOnlyInView(PictureViewId); // excludes it from 3D views' bounds
  render->SetNodeReferenceID(role, volume->GetID());
  this->MoveToRenderFolder(render, volume);
  return volume;
}

void vtkSlicerFenestraLogic::AddSurface(Node* render, vtkPolyData* surface) {
  vtkMRMLScene* scene = this->GetMRMLScene();
  const std::string name = std::string(render->GetName()) + " " + Node::SurfaceRole;
  auto* model = vtkMRMLModelNode::SafeDownCast(
      scene->AddNewNodeByClass("vtkMRMLModelNode", scene->GenerateUniqueName(name.c_str())));
  model->SetAndObservePolyData(surface);
  model->CreateDefaultDisplayNodes();
  vtkMRMLDisplayNode* display = model->GetDisplayNode();
  display->SetColor(0.44, 0.69, 0.78);
  display->SetOpacity(0.5);
  display->SetVisibility(false); // it would cover the anatomy
  render->SetNodeReferenceID(Node::SurfaceRole, model->GetID());
  this->MoveToRenderFolder(render, model);
}

/// Moves the image's plane toward the camera until it is outside the volume. A slice view of that
/// plane then intersects no segments or models.
SlicerExport::Matrix
vtkSlicerFenestraLogic::MoveOutsideVolume(Node* render, const SlicerExport::Matrix& ijkToRas) {
  auto* volume = vtkMRMLVolumeNode::SafeDownCast(render->GetNodeReference(Node::VolumeRole));
  SlicerExport::Matrix moved = ijkToRas;
  if (!volume)
    return moved;
  double bounds[6];
  volume->GetRASBounds(bounds);
  const double diagonal =
      std::hypot(bounds[1] - bounds[0], bounds[3] - bounds[2], bounds[5] - bounds[4]);
  const double length = std::hypot(ijkToRas[2], ijkToRas[6], ijkToRas[10]); // of k axis
  for (int row = 0; row < 3; ++row)
    moved[4 * row + 3] -= 2.0 * diagonal / length * ijkToRas[4 * row + 2];
  return moved;
}

/// Adds frames as a volume, or replaces those of a resumed turntable. Each frame has its own
/// camera, so the volume gets a place beside the anatomy, with pixels of 1 mm.
void vtkSlicerFenestraLogic::AddFrames(Node* render, vtkImageData* frames) {
  if (auto* picture = vtkMRMLVolumeNode::SafeDownCast(render->GetNodeReference(Node::PictureRole)))
    return picture->SetAndObserveImageData(frames);
  double bounds[6] = {0.0, 0.0, 0.0, 0.0, 0.0, 0.0};
  if (auto* volume = vtkMRMLVolumeNode::SafeDownCast(render->GetNodeReference(Node::VolumeRole)))
    volume->GetRASBounds(bounds);
  SlicerExport::Matrix ijkToRas = {1, 0, 0, 0, 0, -1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1};
  const int* size = frames->GetDimensions();
  for (size_t axis = 0; axis < 3; ++axis)
    ijkToRas[4 * axis + 3] = 2.0 * bounds[2 * axis + 1] - bounds[2 * axis] + size[axis];
  this->AddVolume(render, "vtkMRMLVectorVolumeNode", Node::PictureRole, frames, ijkToRas);
}

void vtkSlicerFenestraLogic::AddResult(Node* render, const FenestraResult& result, int step) {
  if (render->IsTurntable()) {
    if (step == 0)
      this->AddFrames(render, result.picture);
    return;
  }
  if (step == 0)
    this->AddVolume(render, "vtkMRMLVectorVolumeNode", Node::PictureRole, result.picture,
                    this->MoveOutsideVolume(render, result.radiance.ijkToRas));
  if (step == 1)
    this->AddVolume(render, "vtkMRMLVectorVolumeNode", Node::RadianceRole, ToVtk(result.radiance),
                    result.radiance.ijkToRas);
  if (step == 2)
    SetWindowToFiniteRange(this->AddVolume(render, "vtkMRMLScalarVolumeNode", Node::DepthRole,
                                           ToVtk(result.depth), result.depth.ijkToRas),
                           result.depth);
  if (step == 3 && result.surface && result.surface->GetNumberOfPoints() > 0)
    this->AddSurface(render, result.surface);
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

int vtkSlicerFenestraLogic::GetNumberOfFrames(Node* render) {
  if (!render)
    return 0;
  auto* picture = vtkMRMLVolumeNode::SafeDownCast(render->GetNodeReference(Node::PictureRole));
  return picture && picture->GetImageData() ? picture->GetImageData()->GetDimensions()[2] : 0;
}
