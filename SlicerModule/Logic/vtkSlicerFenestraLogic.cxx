#include "vtkSlicerFenestraLogic.h"

#include "FenestraFlags.h"
#include "vtkMRMLFenestraOpeningNode.h"
#include "vtkMRMLFenestraPictureDisplayNode.h"
#include "vtkMRMLFenestraRenderNode.h"
#include "vtkSlicerFenestraSnapshot.h"

#include <vtkMRMLApplicationLogic.h>
#include <vtkMRMLCameraNode.h>
#include <vtkMRMLMarkupsPlaneNode.h>
#include <vtkMRMLScalarVolumeNode.h>
#include <vtkMRMLScene.h>
#include <vtkMRMLSegmentationNode.h>
#include <vtkMRMLViewNode.h>

#include <vtkSegmentation.h>

#include <vtkCommand.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>

#include <cstring>
#include <sstream>

vtkStandardNewMacro(vtkSlicerFenestraLogic);

namespace {
using Node = vtkMRMLFenestraRenderNode;

std::string formatNumber(double value) {
  std::ostringstream text;
  text.precision(17);
  text << value;
  return text.str();
}

std::string formatTriple(const double* values) {
  return formatNumber(values[0]) + "," + formatNumber(values[1]) + "," + formatNumber(values[2]);
}

} // namespace

vtkSlicerFenestraLogic::vtkSlicerFenestraLogic() = default;
vtkSlicerFenestraLogic::~vtkSlicerFenestraLogic() = default;

void vtkSlicerFenestraLogic::PrintSelf(ostream& os, vtkIndent indent) {
  Superclass::PrintSelf(os, indent);
}

void vtkSlicerFenestraLogic::RegisterNodes() {
  vtkMRMLScene* scene = this->GetMRMLScene();
  if (!scene)
    return;
  scene->RegisterNodeClass(vtkSmartPointer<Node>::New());
  scene->RegisterNodeClass(vtkSmartPointer<vtkMRMLFenestraOpeningNode>::New());
  scene->RegisterNodeClass(vtkSmartPointer<vtkMRMLFenestraPictureDisplayNode>::New());
}

void vtkSlicerFenestraLogic::SetMRMLSceneInternal(vtkMRMLScene* scene) {
  vtkNew<vtkIntArray> events;
  events->InsertNextValue(vtkMRMLScene::StartImportEvent);
  events->InsertNextValue(vtkMRMLScene::NodeAddedEvent);
  events->InsertNextValue(vtkMRMLScene::NodeRemovedEvent);
  this->SetAndObserveMRMLSceneEventsInternal(scene, events);
}

Node* vtkSlicerFenestraLogic::GetSettings() {
  vtkMRMLScene* scene = this->GetMRMLScene();
  if (!scene)
    return nullptr;
  if (vtkMRMLNode* node = scene->GetSingletonNode("Settings", "vtkMRMLFenestraRenderNode"))
    return Node::SafeDownCast(node);
  vtkNew<Node> node;
  node->SetName("Fenestra settings");
  node->SetSingletonTag("Settings");
  node->SetHideFromEditors(true);
  ResetSettings(node);
  return Node::SafeDownCast(scene->AddNode(node));
}

void vtkSlicerFenestraLogic::ResetSettings(Node* settings) {
  if (!settings)
    return;
  vtkNew<Node> defaults;
  defaults->SetFlags({{"samples", "256"},
                      {"noise", "0.05"},
                      {"size", "512x512"},
                      {"background", "dark"},
                      {"frames", "36"},
                      {"degrees", "360"},
                      {"focus", settings->GetFlag("focus")}});
  const int wasModifying = settings->StartModify();
  for (const char* role : {Node::ViewRole, Node::PlaneRole})
    settings->SetNodeReferenceID(role, nullptr);
  settings->RemoveAttribute(Node::LightsAttribute);
  settings->SetAttribute(Node::ViewSizeAttribute, "1 512x512");
  settings->CopyFlags(defaults);
  settings->EndModify(wasModifying);
}

Node* vtkSlicerFenestraLogic::AddRender(Node* settings, bool turntable) {
  vtkMRMLScene* scene = this->GetMRMLScene();
  if (!scene || !settings)
    return nullptr;
  vtkMRMLNode* volume = settings->GetNodeReference(Node::VolumeRole);
  const std::string base =
      std::string(volume ? volume->GetName() : "Volume") + (turntable ? " turntable" : " render");
  std::string name = base; // the scene's GenerateUniqueName also counts renders that failed
  for (int i = 1; scene->GetFirstNodeByName(name.c_str()); ++i)
    name = base + "_" + std::to_string(i);
  auto* render = Node::SafeDownCast(scene->AddNewNodeByClass("vtkMRMLFenestraRenderNode", name));
  for (const char* role : {Node::VolumeRole, Node::SegmentationRole, Node::ViewRole})
    render->SetNodeReferenceID(role, settings->GetNodeReferenceID(role));
  for (const std::string& attribute : settings->GetAttributeNames())
    render->SetAttribute(attribute.c_str(), settings->GetAttribute(attribute.c_str()));
  std::map<std::string, std::string> flags = this->GetFlags(settings);
  for (const std::string& flag : Node::GetTurntableFlagNames())
    if (!turntable)
      flags.erase(flag);
  render->SetFlags(flags);
  return render;
}

Node* vtkSlicerFenestraLogic::Render(Node* settings, bool wait) {
  return this->Start(settings, false, wait);
}

Node* vtkSlicerFenestraLogic::RenderTurntable(Node* settings, bool wait) {
  return this->Start(settings, true, wait);
}

Node* vtkSlicerFenestraLogic::Start(Node* settings, bool turntable, bool wait) {
  const vtkSmartPointer<Node> render = this->AddRender(settings, turntable);
  if (!render) {
    vtkErrorMacro("Render: " << (settings ? "no scene" : "no settings"));
    return nullptr;
  }
  this->InvokeEvent(RenderRequestedEvent, render.GetPointer());
  if (render->GetRenderState() == Node::NotRequested) {
    vtkErrorMacro("Render: the Fenestra module is not loaded");
    this->GetMRMLScene()->RemoveNode(render);
  }
  if (wait && render->IsRendering())
    this->InvokeEvent(RenderWaitEvent, render.GetPointer());
  const bool failed = !render->GetScene() || (wait && !render->GetNodeReference(Node::PictureRole));
  return failed ? nullptr : render.GetPointer();
}

vtkMRMLScalarVolumeNode* vtkSlicerFenestraLogic::LoadSample() {
  vtkMRMLScene* scene = this->GetMRMLScene();
  const auto findVolumes = [scene] {
    std::vector<vtkMRMLNode*> volumes;
    if (scene)
      scene->GetNodesByClass("vtkMRMLScalarVolumeNode", volumes);
    return volumes;
  };
  const size_t before = findVolumes().size();
  this->InvokeEvent(SampleRequestedEvent);
  const std::vector<vtkMRMLNode*> volumes = findVolumes();
  if (volumes.size() > before)
    return vtkMRMLScalarVolumeNode::SafeDownCast(volumes.back());
  vtkErrorMacro("LoadSample: the sample was not loaded");
  return nullptr;
}

void vtkSlicerFenestraLogic::StopRender() {
  this->InvokeEvent(StopRequestedEvent);
}

bool vtkSlicerFenestraLogic::IsRendering(Node* render) {
  return render && render->IsRendering();
}

std::string vtkSlicerFenestraLogic::WriteScene(Node* render, const std::string& folder) {
  if (!render)
    return {};
  try {
    SlicerExport::createFolder(folder); // TakeRendering uses it, too
    return SlicerExport::Writer(folder).write(this->Snapshot(render, folder)).string();
  } catch (const std::exception& error) {
    vtkErrorMacro("WriteScene: " << error.what());
    return {};
  }
}

void vtkSlicerFenestraLogic::UseCamera(Node* render, vtkMRMLCameraNode* camera) {
  if (!render || !camera)
    return;
  std::map<std::string, std::string> flags = render->GetFlags();
  for (const char* name : {"view", "scale", "angle"})
    flags.erase(name);
  for (const auto& [name, value] : GetCameraFlags(camera))
    flags[name] = value;
  render->SetFlags(flags);
}

SlicerExport::Contents vtkSlicerFenestraLogic::Snapshot(Node* render,
                                                        const std::filesystem::path& folder) {
  auto* volume = vtkMRMLScalarVolumeNode::SafeDownCast(render->GetNodeReference(Node::VolumeRole));
  auto* segmentation =
      vtkMRMLSegmentationNode::SafeDownCast(render->GetNodeReference(Node::SegmentationRole));
  SlicerExport::Contents contents;
  vtkSlicerFenestraSnapshot::TakeVolume(volume, contents);
  vtkSlicerFenestraSnapshot::TakeRendering(volume, folder, contents);
  if (!segmentation && !render->GetFocus().empty())
    throw SlicerExport::UserError("The segmentation of the focus was removed. Choose one.");
  if (segmentation)
    vtkSlicerFenestraSnapshot::TakeSegmentation(segmentation, render->GetFocus(), contents);
  return contents;
}

const std::vector<unsigned long>& vtkSlicerFenestraLogic::GetDataEvents() {
  static const std::vector<unsigned long> events = {
      vtkCommand::ModifiedEvent,
      vtkMRMLVolumeNode::ImageDataModifiedEvent,
      vtkMRMLTransformableNode::TransformModifiedEvent,
      vtkMRMLDisplayableNode::DisplayModifiedEvent,
      vtkSegmentation::RepresentationModified,
      vtkSegmentation::SegmentAdded,
      vtkSegmentation::SegmentRemoved,
      vtkSegmentation::SegmentModified};
  return events;
}

std::vector<SlicerExport::Segment> vtkSlicerFenestraLogic::GetSegments(Node* render) {
  auto* segmentation =
      render
          ? vtkMRMLSegmentationNode::SafeDownCast(render->GetNodeReference(Node::SegmentationRole))
          : nullptr;
  return segmentation ? vtkSlicerFenestraSnapshot::ListSegments(segmentation)
                      : std::vector<SlicerExport::Segment>();
}

std::vector<std::string> vtkSlicerFenestraLogic::GetSegmentIDs(Node* render) {
  std::vector<std::string> ids;
  for (const SlicerExport::Segment& segment : GetSegments(render))
    ids.push_back(segment.id);
  return ids;
}

vtkMRMLCameraNode* vtkSlicerFenestraLogic::GetFollowedCamera(Node* render) {
  if (!render || !render->GetFlag("view").empty() || !render->GetFlag("position").empty())
    return nullptr;
  return this->GetCamera(vtkMRMLViewNode::SafeDownCast(render->GetNodeReference(Node::ViewRole)));
}

vtkMRMLCameraNode* vtkSlicerFenestraLogic::GetCamera(vtkMRMLViewNode* view) {
  if (!view || !this->GetMRMLScene())
    return nullptr;
  std::vector<vtkMRMLNode*> cameras;
  this->GetMRMLScene()->GetNodesByClass("vtkMRMLCameraNode", cameras);
  for (vtkMRMLNode* node : cameras) {
    auto* camera = vtkMRMLCameraNode::SafeDownCast(node);
    if (camera->GetLayoutName() && view->GetLayoutName() &&
        std::strcmp(camera->GetLayoutName(), view->GetLayoutName()) == 0)
      return camera;
  }
  return nullptr;
}

std::map<std::string, std::string> vtkSlicerFenestraLogic::GetFlags(Node* render) {
  std::map<std::string, std::string> flags = render->GetFlags();
  if (vtkMRMLCameraNode* camera = this->GetFollowedCamera(render))
    for (const auto& [name, value] : GetCameraFlags(camera))
      flags[name] = value;
  return flags;
}

std::map<std::string, std::string>
vtkSlicerFenestraLogic::GetCameraFlags(vtkMRMLCameraNode* camera) {
  std::map<std::string, std::string> flags = {{"position", formatTriple(camera->GetPosition())},
                                              {"target", formatTriple(camera->GetFocalPoint())},
                                              {"up", formatTriple(camera->GetViewUp())}};
  const bool parallel = camera->GetParallelProjection() != 0;
  flags["projection"] = parallel ? "orthographic" : "perspective";
  if (parallel)
    flags["scale"] = formatNumber(camera->GetParallelScale());
  else
    flags["angle"] = formatNumber(camera->GetViewAngle());
  return flags;
}

std::string vtkSlicerFenestraLogic::GetPlaneFlag(vtkMRMLNode* node) {
  auto* plane = vtkMRMLMarkupsPlaneNode::SafeDownCast(node);
  if (!plane || !plane->GetIsPlaneValid())
    return {};
  double origin[3], normal[3];
  plane->GetOriginWorld(origin);
  plane->GetNormalWorld(normal);
  return formatTriple(origin) + "," + formatTriple(normal);
}

bool vtkSlicerFenestraLogic::HasFocus(Node* render) {
  return render && (!render->GetFlag("focus").empty() || !render->GetFlag("preset").empty());
}

bool vtkSlicerFenestraLogic::HasSurface(Node* render) {
  if (!render)
    return false;
  const std::string mode = render->GetFlag("clip");
  if (mode.empty() || mode == "auto") // a focus is clipped by a surface
    return HasFocus(render);
  return mode != "none" && mode != "plane";
}

std::vector<std::string> vtkSlicerFenestraLogic::GetArguments(Node* render, bool withSurface) {
  if (!render)
    return {};
  const std::map<std::string, std::string> flags = render->GetFlags();
  const auto denoise = flags.find("denoise");
  const bool isDenoised = denoise == flags.end() || denoise->second != "off";
  std::vector<std::string> arguments = {"--stats=stats.json"};
  if (render->IsTurntable())
    arguments.push_back("--output=frame.png");
  else // slow compression of further layers would delay a stop
    arguments.insert(arguments.end(),
                     {"--output=picture.png", "--output=picture.exr", "--output=radiance.nrrd",
                      isDenoised ? "--layers=color,depth,depth50" : "--layers=color,depth"});
  if (withSurface && !render->IsTurntable())
    arguments.push_back("--surface=surface.vtp");
  if (isDenoised && flags.count("noise") > 0 && flags.count("noisetarget") == 0)
    arguments.push_back("--noisetarget=denoised");
  const std::vector<std::string> values = SlicerExport::toArguments(flags);
  arguments.insert(arguments.end(), values.begin(), values.end());
  return arguments;
}
