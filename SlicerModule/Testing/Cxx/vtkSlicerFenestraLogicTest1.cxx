// Data that the logic collects for the renderer, and its error messages.

#include "FenestraTesting.h"

#include "vtkMRMLFenestraRenderNode.h"
#include "vtkSlicerFenestraLogic.h"

#include <vtkMRMLBSplineTransformNode.h>
#include <vtkMRMLCameraNode.h>
#include <vtkMRMLLinearTransformNode.h>
#include <vtkMRMLMarkupsPlaneNode.h>
#include <vtkMRMLViewNode.h>
#include <vtkMatrix4x4.h>
#include <vtkPointData.h>
#include <vtkSegment.h>
#include <vtkSegmentationConverter.h>
#include <vtkTransform.h>

#include <algorithm>

namespace {

using Node = vtkMRMLFenestraRenderNode;

const auto folder = std::filesystem::temp_directory_path(); // these tests write no files

/// Error message of a snapshot; empty: success.
std::string getSnapshotError(vtkSlicerFenestraLogic* logic, Node* node) {
  try {
    logic->Snapshot(node, folder);
    return {};
  } catch (const SlicerExport::UserError& error) {
    return error.what();
  }
}

bool has(const std::string& text, const char* part) {
  return text.find(part) != std::string::npos;
}

int testCamera(vtkMRMLScene* scene, vtkSlicerFenestraLogic* logic, Node* settings) {
  auto* view = vtkMRMLViewNode::SafeDownCast(scene->AddNewNodeByClass("vtkMRMLViewNode", "View"));
  auto* camera =
      vtkMRMLCameraNode::SafeDownCast(scene->AddNewNodeByClass("vtkMRMLCameraNode", "Camera"));
  view->SetLayoutName("1");
  camera->SetLayoutName("1");
  camera->SetPosition(0.1, -200.0, 0.3);
  camera->SetFocalPoint(0.0, 0.0, 0.0);
  camera->SetParallelProjection(1);
  camera->SetParallelScale(1.0 / 3.0);
  settings->SetNodeReferenceID(Node::ViewRole, view->GetID());
  CHECK_POINTER(logic->GetFollowedCamera(settings), camera);
  auto flags = logic->GetFlags(settings);
  CHECK_STD_STRING(flags["projection"], "orthographic");
  CHECK_DOUBLE(std::stod(flags["scale"]), 1.0 / 3.0); // all digits
  CHECK_BOOL(flags.count("angle") == 0, true);
  camera->SetParallelProjection(0);
  flags = logic->GetFlags(settings);
  CHECK_STD_STRING(flags["angle"], "30");
  // A render's view is fixed.
  Node* render = logic->AddRender(settings);
  CHECK_NULL(logic->GetFollowedCamera(render));
  CHECK_STD_STRING(render->GetFlag("position"), flags["position"]);
  settings->SetFlag("view", "left");
  CHECK_NULL(logic->GetFollowedCamera(settings));
  CHECK_BOOL(logic->GetFlags(settings).count("position") == 0, true);
  return EXIT_SUCCESS;
}

/// A segmentation of surfaces is converted once, and again after a change of a surface.
int testSurfaces(vtkSlicerFenestraLogic* logic, Node* settings) {
  auto* node =
      vtkMRMLSegmentationNode::SafeDownCast(settings->GetNodeReference(Node::SegmentationRole));
  const std::string surface = vtkSegmentationConverter::GetClosedSurfaceRepresentationName();
  vtkNew<vtkSegmentation> labels;
  labels->DeepCopy(node->GetSegmentation());
  vtkNew<vtkSegmentation> surfaces;
  surfaces->DeepCopy(labels);
  CHECK_BOOL(surfaces->CreateRepresentation(surface), true);
#if Slicer_VERSION_MAJOR > 5 || (Slicer_VERSION_MAJOR == 5 && Slicer_VERSION_MINOR >= 4)
  surfaces->SetSourceRepresentationName(surface);
#else
  surfaces->SetMasterRepresentationName(surface);
#endif
  surfaces->RemoveRepresentation(vtkSegmentationConverter::GetBinaryLabelmapRepresentationName());
  node->SetAndObserveSegmentation(surfaces);
  const SlicerExport::Contents first = logic->Snapshot(settings, folder);
  CHECK_BOOL(first.segmentation.segments.empty(), false);
  const SlicerExport::Contents second = logic->Snapshot(settings, folder);
  CHECK_STD_STRING(second.segmentationKey, first.segmentationKey);
  CHECK_BOOL(second.segmentation.layers[0].labels.data == first.segmentation.layers[0].labels.data,
             true);
  surfaces->GetNthSegment(0)->GetRepresentation(surface)->Modified();
  CHECK_BOOL(logic->Snapshot(settings, folder).segmentationKey != first.segmentationKey, true);
  node->SetAndObserveSegmentation(labels);
  return EXIT_SUCCESS;
}

int testSubject(vtkMRMLScene* scene, vtkSlicerFenestraLogic* logic, Node* settings) {
  CHECK_BOOL(has(getSnapshotError(logic, settings), "no volume"), true);
  vtkMRMLScalarVolumeNode* volume = FenestraTesting::addVolume(scene);
  settings->SetNodeReferenceID(Node::VolumeRole, volume->GetID());
  CHECK_STD_STRING(getSnapshotError(logic, settings), "");
  SlicerExport::Contents contents = logic->Snapshot(settings, folder);
  CHECK_STD_STRING(contents.volume.type, "int16");
  CHECK_BOOL(contents.volume.data.get() == volume->GetImageData()->GetScalarPointer(), true);
  CHECK_BOOL(contents.property.empty(), true);
  const std::string key = contents.volumeKey;
  CHECK_STD_STRING(logic->Snapshot(settings, folder).volumeKey, key);
  volume->GetImageData()->GetPointData()->GetScalars()->Modified();
  CHECK_BOOL(logic->Snapshot(settings, folder).volumeKey != key, true);

  vtkMRMLSegmentationNode* segmentation = FenestraTesting::addSegmentation(scene);
  settings->SetNodeReferenceID(Node::SegmentationRole, segmentation->GetID());
  std::vector<std::string> ids;
  segmentation->GetSegmentation()->GetSegmentIDs(ids);
  settings->SetFocus({ids[0]});
  contents = logic->Snapshot(settings, folder);
  CHECK_BOOL(contents.segmentation.segments.empty(), false);
  CHECK_STD_STRING(contents.segmentation.segments[0].name, "Ball");
  segmentation->GetSegmentation()->GetSegment(ids[0])->SetTag(
      vtkSegment::GetTerminologyEntryTagName(), "a~SCT^1^b");
  CHECK_STD_STRING(logic->Snapshot(settings, folder).segmentation.segments[0].tags,
                   "TerminologyEntry:a~SCT^1^b|");
  CHECK_BOOL(vtkSlicerFenestraLogic::GetSegments(nullptr).empty(), true);
  const std::string before = logic->Snapshot(settings, folder).segmentationKey;
  segmentation->GetSegmentation()->GetSegment(ids[0])->SetColor(0.25, 0.5, 1.0);
  contents = logic->Snapshot(settings, folder);
  CHECK_BOOL(contents.segmentationKey != before, true);
  const auto named = vtkSlicerFenestraLogic::GetSegments(settings);
  CHECK_INT(static_cast<int>(named.size()), 2); // includes the empty segment
  CHECK_BOOL(vtkSlicerFenestraLogic::GetSegmentIDs(settings) == ids, true);
  for (const SlicerExport::Segment& one : {contents.segmentation.segments[0], named[0]}) {
    CHECK_STD_STRING(one.id, ids[0]);
    CHECK_STD_STRING(one.tags, "TerminologyEntry:a~SCT^1^b|");
    CHECK_DOUBLE(one.color[0], 0.25);
  }
  CHECK_EXIT_SUCCESS(testSurfaces(logic, settings));
  settings->SetFocus({"gone"});
  CHECK_BOOL(has(getSnapshotError(logic, settings), "gone"), true);
  settings->SetFocus({ids[0]});

  vtkNew<vtkMatrix4x4> shift;
  shift->SetElement(0, 3, 12.5);
  auto* transform = vtkMRMLLinearTransformNode::SafeDownCast(
      scene->AddNewNodeByClass("vtkMRMLLinearTransformNode", "Shift"));
  transform->SetMatrixTransformToParent(shift);
  segmentation->SetAndObserveTransformNodeID(transform->GetID());
  CHECK_DOUBLE(logic->Snapshot(settings, folder).segmentation.toWorld[3], 12.5);
  auto* bending = scene->AddNewNodeByClass("vtkMRMLBSplineTransformNode", "Bending");
  volume->SetAndObserveTransformNodeID(bending->GetID());
  CHECK_BOOL(has(getSnapshotError(logic, settings), "Harden"), true);
  volume->SetAndObserveTransformNodeID(nullptr);
  const std::map<int, const char*> types = {
      {VTK_SIGNED_CHAR, "int8"},      {VTK_UNSIGNED_CHAR, "uint8"},
      {VTK_UNSIGNED_SHORT, "uint16"}, {VTK_UNSIGNED_INT, "uint32"},
      {VTK_LONG_LONG, "int64"},       {VTK_UNSIGNED_LONG_LONG, "uint64"},
      {VTK_FLOAT, "float"},           {VTK_DOUBLE, "double"}};
  for (const auto& [type, name] : types) {
    volume->GetImageData()->AllocateScalars(type, 1);
    CHECK_STD_STRING(logic->Snapshot(settings, folder).volume.type, name);
  }
  return EXIT_SUCCESS;
}

int testPlane(vtkMRMLScene* scene) {
  scene->RegisterNodeClass(vtkSmartPointer<vtkMRMLMarkupsPlaneNode>::New());
  auto* plane = vtkMRMLMarkupsPlaneNode::SafeDownCast(
      scene->AddNewNodeByClass("vtkMRMLMarkupsPlaneNode", "Cut"));
  CHECK_STD_STRING(vtkSlicerFenestraLogic::GetPlaneFlag(nullptr), "");
  CHECK_STD_STRING(vtkSlicerFenestraLogic::GetPlaneFlag(plane), ""); // not placed
  plane->SetOrigin(1.0, -2.5, 3.0);
  plane->SetNormal(0.0, 1.0, 0.0);
  const std::string flag = vtkSlicerFenestraLogic::GetPlaneFlag(plane);
  CHECK_BOOL(FenestraTesting::isNear(flag, {1.0, -2.5, 3.0, 0.0, 1.0, 0.0}), true);
  return EXIT_SUCCESS;
}

/// An image's node has no turntable flags.
int testTurntable(vtkSlicerFenestraLogic* logic, Node* settings) {
  settings->SetFlag("frames", "12");
  settings->SetFlag("degrees", "90");
  CHECK_BOOL(settings->IsTurntable(), false);
  CHECK_BOOL(logic->AddRender(settings)->IsTurntable(), false);
  Node* turntable = logic->AddRender(settings, true);
  CHECK_BOOL(turntable->IsTurntable(), true);
  const auto says = [](Node* render, const std::string& argument) {
    const auto all = vtkSlicerFenestraLogic::GetArguments(render, true);
    return std::find(all.begin(), all.end(), argument) != all.end();
  };
  for (const char* argument : {"--output=frame.png", "--frames=12", "--degrees=90"}) {
    CHECK_BOOL(says(turntable, argument), true);
    CHECK_BOOL(says(logic->AddRender(settings), argument), false);
  }
  CHECK_BOOL(says(logic->AddRender(settings), "--surface=surface.vtp"), true);
  settings->SetFlag("material", "a: clip=no,b\\, c: clip=no"); // two values of one flag
  CHECK_BOOL(says(logic->AddRender(settings), "--material=a: clip=no"), true);
  CHECK_BOOL(says(logic->AddRender(settings), "--material=b, c: clip=no"), true);
  settings->SetFlag("material", "");
  CHECK_BOOL(says(turntable, "--surface=surface.vtp"), false);
  CHECK_INT(vtkSlicerFenestraLogic::GetNumberOfFrames(turntable), 0);
  return EXIT_SUCCESS;
}

/// Settings are as new, except what to show; values of an untrusted scene are dropped.
int testReset(vtkSlicerFenestraLogic* logic, Node* settings) {
  const char* attributes[] = {"transfer", "/nowhere/mine.json", "later", "1", nullptr};
  settings->ReadXMLAttributes(attributes);
  settings->SetFlags({{"focus", "a"}, {"view", "left"}, {"size", "30x20"}});
  settings->SetAttribute(Node::LightsAttribute, "cinema 50 100 100 100");
  vtkMRMLNode* const volume = settings->GetNodeReference(Node::VolumeRole);
  CHECK_NOT_NULL(volume);
  vtkSlicerFenestraLogic::ResetSettings(settings);
  CHECK_POINTER(settings->GetNodeReference(Node::VolumeRole), volume);
  CHECK_NULL(settings->GetNodeReference(Node::ViewRole));
  CHECK_NULL(settings->GetAttribute(Node::LightsAttribute));
  vtkNew<vtkMRMLScene> other;
  logic->SetMRMLScene(other);
  std::map<std::string, std::string> expected = logic->GetSettings()->GetFlags();
  expected["focus"] = "a";
  CHECK_BOOL(settings->GetFlags() == expected, true);
  CHECK_BOOL(settings->GetWithheld().empty(), true);
  vtkSlicerFenestraLogic::ResetSettings(nullptr);
  return EXIT_SUCCESS;
}

} // namespace

int vtkSlicerFenestraLogicTest1(int, char*[]) {
  FenestraTesting::registerConverters();
  vtkNew<vtkMRMLScene> scene;
  vtkNew<vtkSlicerFenestraLogic> logic;
  EXERCISE_BASIC_OBJECT_METHODS(logic.GetPointer());
  logic->SetMRMLScene(scene);
  Node* settings = logic->GetSettings();
  CHECK_NOT_NULL(settings);
  CHECK_POINTER(logic->GetSettings(), settings);
  CHECK_EXIT_SUCCESS(testSubject(scene, logic, settings));
  CHECK_EXIT_SUCCESS(testCamera(scene, logic, settings));
  CHECK_EXIT_SUCCESS(testPlane(scene));
  CHECK_EXIT_SUCCESS(testTurntable(logic, settings));
  const auto hasSurface = [settings](const std::map<std::string, std::string>& flags) {
    settings->SetFlags(flags);
    return vtkSlicerFenestraLogic::HasSurface(settings);
  };
  CHECK_BOOL(hasSurface({{"focus", "a"}}), true);
  CHECK_BOOL(hasSurface({{"focus", "a"}, {"clip", "ghost"}}), true);
  CHECK_BOOL(hasSurface({{"focus", "a"}, {"clip", "plane"}}), false);
  CHECK_BOOL(hasSurface({{"preset", "liver"}}), true);
  CHECK_BOOL(hasSurface({{"focus", "a"}, {"clip", "none"}}), false);
  CHECK_BOOL(hasSurface({}), false);
  CHECK_BOOL(vtkSlicerFenestraLogic::HasSurface(nullptr), false);
  CHECK_EXIT_SUCCESS(testReset(logic, settings));
  return EXIT_SUCCESS;
}
