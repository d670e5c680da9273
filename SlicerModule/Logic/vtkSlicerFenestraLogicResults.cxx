#include "vtkSlicerFenestraLogic.h"

#include "FenestraImagePoint.h"
#include "vtkMRMLFenestraRenderNode.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <limits>
#include <vtkImageData.h>
#include <vtkImageExtractComponents.h>
#include <vtkImageFlip.h>
#include <vtkMRMLModelNode.h>
#include <vtkMRMLScalarVolumeDisplayNode.h>
#include <vtkMRMLScalarVolumeNode.h>
#include <vtkMRMLScene.h>
#include <vtkMRMLSubjectHierarchyNode.h>
#include <vtkMRMLVectorVolumeNode.h>
#include <vtkMatrix4x4.h>
#include <vtkNew.h>
#include <vtkPNGReader.h>
#include <vtkPolyData.h>
#include <vtkStringArray.h>
#include <vtkXMLPolyDataReader.h>

namespace {
using Node = vtkMRMLFenestraRenderNode;

constexpr const char* PictureViewId = "vtkMRMLSliceNodeFenestra"; // class and singleton tag

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
  const std::string middle = folder + "/radiance-depth50.nrrd"; // written if denoised
  result.depth =
      ReadFloatImage(std::filesystem::exists(middle) ? middle : folder + "/radiance-Z.nrrd");
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

/// Moves a result into the render's folder of the subject hierarchy, below the render's volume.
void vtkSlicerFenestraLogic::MoveToRenderFolder(Node* render, vtkMRMLNode* result) {
  auto* hierarchy = vtkMRMLSubjectHierarchyNode::GetSubjectHierarchyNode(this->GetMRMLScene());
  if (!hierarchy)
    return;
  const vtkIdType none = vtkMRMLSubjectHierarchyNode::GetInvalidItemID();
  vtkMRMLNode* source = render->GetNodeReference(Node::VolumeRole);
  const vtkIdType volume = source ? hierarchy->GetItemByDataNode(source) : none;
  const vtkIdType parent =
      volume != none ? hierarchy->GetItemParent(volume) : hierarchy->GetSceneItemID();
  vtkIdType folder = hierarchy->GetItemChildWithName(parent, render->GetName());
  if (folder == none) {
    folder = hierarchy->CreateFolderItem(parent, render->GetName());
    const int below = volume != none ? hierarchy->GetItemPositionUnderParent(volume) + 1 : -1;
    if (below > 0)
      hierarchy->MoveItem(folder, hierarchy->GetItemByPositionUnderParent(parent, below));
  }
  hierarchy->CreateItem(folder, result); // or moves it
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

void vtkSlicerFenestraLogic::AddDepth(Node* render, const SlicerExport::Image& depth) {
  vtkMRMLVolumeNode* volume = this->AddVolume(render, "vtkMRMLScalarVolumeNode", Node::DepthRole,
                                              ToVtk(depth), depth.ijkToRas);
  const auto camera = depth.fields.find(SlicerExport::cameraField);
  if (camera != depth.fields.end())
    volume->SetAttribute(Node::CameraAttribute, camera->second.c_str());
  SetWindowToFiniteRange(volume, depth);
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
    this->AddDepth(render, result.depth);
  if (step == 3 && result.surface && result.surface->GetNumberOfPoints() > 0)
    this->AddSurface(render, result.surface);
}

int vtkSlicerFenestraLogic::GetNumberOfFrames(Node* render) {
  if (!render)
    return 0;
  auto* picture = vtkMRMLVolumeNode::SafeDownCast(render->GetNodeReference(Node::PictureRole));
  return picture && picture->GetImageData() ? picture->GetImageData()->GetDimensions()[2] : 0;
}
