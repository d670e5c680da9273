// The node that keeps what a picture was made of: written, read, copied.

#include "FenestraTesting.h"

#include "vtkMRMLFenestraRenderNode.h"

#include <vtkNew.h>

int vtkMRMLFenestraRenderNodeTest1(int, char*[]) {
  using Node = vtkMRMLFenestraRenderNode;
  vtkNew<Node> node;
  EXERCISE_ALL_BASIC_MRML_METHODS(node.GetPointer());

  vtkNew<vtkMRMLScene> scene;
  scene->RegisterNodeClass(vtkSmartPointer<Node>::New());
  auto* first = Node::SafeDownCast(scene->AddNewNodeByClass("vtkMRMLFenestraRenderNode", "Render"));
  vtkMRMLScalarVolumeNode* volume = FenestraTesting::addVolume(scene);
  const std::string awkward =
      R"({"lights": [{"type": "environment", "radiance": [1, 2, 3]}]} <&> 'é')";
  first->SetFlags(
      {{"clip", "surface"}, {"lights", awkward}, {"output", "/etc/passwd"}, {"up", ""}});
  CHECK_STD_STRING(first->GetFlag("lights"), awkward);
  CHECK_STD_STRING(first->GetFlag("output"), ""); // not a setting
  CHECK_INT(static_cast<int>(first->GetFlags().size()), 2);
  first->SetFocus({"a,b", "c", "d\\e"});
  CHECK_INT(static_cast<int>(first->GetFocus().size()), 3);
  CHECK_STD_STRING(first->GetFocus()[0], "a,b");
  CHECK_STD_STRING(first->GetFocus()[2], "d\\e");
  first->SetNodeReferenceID(Node::VolumeRole, volume->GetID());

  scene->SetSaveToXMLString(1);
  scene->Commit();
  const std::string text = scene->GetSceneXMLString();
  std::cout << text;
  vtkNew<vtkMRMLScene> again;
  again->RegisterNodeClass(vtkSmartPointer<Node>::New());
  again->SetLoadFromXMLString(1);
  again->SetSceneXMLString(text);
  CHECK_INT(again->Import(), 1);
  auto* read = Node::SafeDownCast(again->GetFirstNodeByClass("vtkMRMLFenestraRenderNode"));
  CHECK_NOT_NULL(read);
  CHECK_BOOL(read->GetFlags() == first->GetFlags(), true);
  CHECK_BOOL(read->GetFocus() == first->GetFocus(), true);
  CHECK_NOT_NULL(read->GetNodeReference(Node::VolumeRole));

  vtkNew<Node> copy;
  copy->Copy(first);
  CHECK_BOOL(copy->GetFlags() == first->GetFlags(), true);
  // Nothing changed: nobody is told.
  const vtkMTimeType before = first->GetMTime();
  first->SetFlag("clip", "surface");
  CHECK_BOOL(first->GetMTime() == before, true);
  first->SetFlag("clip", "");
  CHECK_INT(static_cast<int>(first->GetFlags().count("clip")), 0);
  return EXIT_SUCCESS;
}
