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

  // Every flag, and what was measured.
  std::map<std::string, std::string> all;
  for (const std::string& name : Node::GetFlagNames())
    all[name] = name + " 1,-0.5";
  read->SetFlags(all);
  CHECK_BOOL(read->GetFlags() == all, true);
  CHECK_BOOL(read->IsTurntable(), true);
  const std::string measures = R"({"boundaryGapMm":{"max":0.1},"focusCoverage":1})";
  read->SetAttribute(Node::MeasuresAttribute, measures.c_str());
  again->SetSaveToXMLString(1);
  again->Commit();
  vtkNew<vtkMRMLScene> third;
  third->RegisterNodeClass(vtkSmartPointer<Node>::New());
  third->SetLoadFromXMLString(1);
  third->SetSceneXMLString(again->GetSceneXMLString());
  CHECK_INT(third->Import(), 1);
  auto* last = Node::SafeDownCast(third->GetFirstNodeByClass("vtkMRMLFenestraRenderNode"));
  CHECK_NOT_NULL(last);
  CHECK_BOOL(last->GetFlags() == all, true);
  CHECK_STD_STRING(last->GetAttribute(Node::MeasuresAttribute), measures);
  for (const std::string& name : Node::GetTurntableFlagNames())
    last->SetFlag(name, "");
  CHECK_BOOL(last->IsTurntable(), false);
  CHECK_INT(static_cast<int>(last->GetFlags().size()),
            static_cast<int>(all.size() - Node::GetTurntableFlagNames().size()));

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
