// Writing, reading and copying the node of settings and results.

#include "FenestraFlags.h"
#include "FenestraTesting.h"

#include "vtkMRMLFenestraRenderNode.h"

#include <vtkNew.h>

namespace {

using Node = vtkMRMLFenestraRenderNode;

/// Valid value for a flag of this kind.
std::string makeValue(SlicerExport::FlagKind kind) {
  using Kind = SlicerExport::FlagKind;
  switch (kind) {
  case Kind::text:
    return "a,b c";
  case Kind::word:
    return "word";
  case Kind::integer:
    return "12";
  case Kind::number:
    return "-0.5";
  case Kind::numberOrAuto:
    return "auto";
  case Kind::size:
    return "8x6";
  case Kind::resource:
    return "studio";
  default:
    return "1,-0.5,3";
  }
}

/// Reads a scene from text and returns its only render node.
Node* readScene(vtkMRMLScene* scene, const std::string& text) {
  scene->RegisterNodeClass(vtkSmartPointer<Node>::New());
  scene->SetLoadFromXMLString(1);
  scene->SetSceneXMLString(text);
  scene->Import();
  return Node::SafeDownCast(scene->GetFirstNodeByClass("vtkMRMLFenestraRenderNode"));
}

std::string writeScene(vtkMRMLScene* scene) {
  scene->SetSaveToXMLString(1);
  scene->Commit();
  return scene->GetSceneXMLString();
}

/// Attributes of a newer version are written again, once, and copied. The base class writes the
/// attributes of all nodes.
int testUnknown() {
  const std::string text =
      R"(<MRML version="Slicer 5.12"><FenestraRender id="r" name="r" description="d" )"
      R"(clip="surface" mood="dark &amp; &quot;deep&quot;"></FenestraRender></MRML>)";
  vtkNew<vtkMRMLScene> scene;
  Node* node = readScene(scene, text);
  CHECK_NOT_NULL(node);
  CHECK_STD_STRING(node->GetFlag("mood"), "");
  node->SetFlag("clip", "cutaway");
  node->SetDescription(nullptr);
  vtkNew<Node> copy;
  copy->CopyContent(node);
  CHECK_STD_STRING(copy->GetFlag("clip"), "cutaway");
  CHECK_BOOL(copy->HasCopyContent(), true);
  for (Node* one : {node, copy.GetPointer()}) {
    std::ostringstream xml;
    one->WriteXML(xml, 0);
    const std::string once = " mood=\"dark &amp; &quot;deep&quot;\"";
    CHECK_BOOL(xml.str().find(once) != std::string::npos, true);
    CHECK_BOOL(xml.str().find(once) == xml.str().rfind(" mood="), true);
    CHECK_BOOL(xml.str().find("description=") == std::string::npos, true);
  }
  return EXIT_SUCCESS;
}

/// File names and invalid values from an untrusted scene are kept, but are not flags.
int testWithheld() {
  const std::string text =
      R"(<MRML version="Slicer 5.2"><FenestraRender id="r" name="r" )"
      R"(clip="surface" frames="x" transfer="/etc/passwd" seed="-1" soft="auto" )"
      R"(lights="{&quot;file&quot;: &quot;a.exr&quot;}"></FenestraRender></MRML>)";
  vtkNew<vtkMRMLScene> scene;
  Node* node = readScene(scene, text);
  CHECK_NOT_NULL(node);
  CHECK_INT(static_cast<int>(node->GetFlags().size()), 2);
  CHECK_STD_STRING(node->GetFlag("clip"), "surface");
  CHECK_INT(static_cast<int>(node->GetWithheld().size()), 4);
  CHECK_BOOL(node->WithholdsFiles(), true);
  CHECK_BOOL(node->IsTurntable(), false);
  vtkNew<vtkMRMLScene> again;
  Node* reread = readScene(again, writeScene(scene));
  CHECK_BOOL(reread->GetWithheld() == node->GetWithheld(), true);
  vtkNew<Node> copy;
  copy->Copy(node);
  CHECK_BOOL(copy->GetWithheld() == node->GetWithheld(), true);
  node->SetFlag("lights", "studio"); // the user chooses another value
  CHECK_INT(static_cast<int>(node->GetWithheld().count("lights")), 0);
  node->AllowFiles();
  CHECK_STD_STRING(node->GetFlag("transfer"), "/etc/passwd");
  CHECK_STD_STRING(node->GetFlag("frames"), "");
  CHECK_BOOL(node->WithholdsFiles(), false);
  CHECK_INT(static_cast<int>(node->GetWithheld().size()), 2); // invalid values
  return EXIT_SUCCESS;
}

/// All flags and the measures are written to a scene and read again.
int testEveryFlag(Node* read) {
  std::map<std::string, std::string> all;
  for (const SlicerExport::Flag& flag : SlicerExport::flags())
    all[flag.name] = makeValue(flag.kind);
  read->SetFlags(all);
  CHECK_BOOL(read->GetFlags() == all, true);
  CHECK_BOOL(read->IsTurntable(), true);
  const std::string measures = R"({"boundaryGapMm":{"max":0.1},"focusCoverage":1})";
  read->SetAttribute(Node::MeasuresAttribute, measures.c_str());
  vtkNew<vtkMRMLScene> third;
  Node* last = readScene(third, writeScene(read->GetScene()));
  CHECK_NOT_NULL(last);
  CHECK_BOOL(last->GetFlags() == all, true);
  CHECK_STD_STRING(last->GetAttribute(Node::MeasuresAttribute), measures);
  for (const std::string& name : Node::GetTurntableFlagNames())
    last->SetFlag(name, "");
  CHECK_BOOL(last->IsTurntable(), false);
  CHECK_INT(static_cast<int>(last->GetFlags().size()),
            static_cast<int>(all.size() - Node::GetTurntableFlagNames().size()));
  return EXIT_SUCCESS;
}

} // namespace

int vtkMRMLFenestraRenderNodeTest1(int, char*[]) {
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

  const std::string text = writeScene(scene);
  std::cout << text;
  vtkNew<vtkMRMLScene> again;
  Node* read = readScene(again, text);
  CHECK_NOT_NULL(read);
  CHECK_BOOL(read->GetFlags() == first->GetFlags(), true);
  CHECK_BOOL(read->GetFocus() == first->GetFocus(), true);
  CHECK_NOT_NULL(read->GetNodeReference(Node::VolumeRole));

  CHECK_EXIT_SUCCESS(testEveryFlag(read));

  vtkNew<Node> copy;
  copy->Copy(first);
  CHECK_BOOL(copy->GetFlags() == first->GetFlags(), true);
  // Setting the same value must not invoke an event.
  const vtkMTimeType before = first->GetMTime();
  first->SetFlag("clip", "surface");
  CHECK_BOOL(first->GetMTime() == before, true);
  TESTING_OUTPUT_ASSERT_ERRORS_BEGIN();
  CHECK_BOOL(first->SetFlag("mood", "dark"), false);
  CHECK_BOOL(first->SetFlag("clip", "Surface"), false);
  TESTING_OUTPUT_ASSERT_ERRORS_END();
  CHECK_BOOL(first->GetMTime() == before, true);
  first->SetFocus("a,b");
  CHECK_BOOL(first->GetFocus() == std::vector<std::string>({"a,b"}), true);
  first->SetFlag("focus", "a\\,b,c");
  CHECK_BOOL(first->GetFocus() == std::vector<std::string>({"a,b", "c"}), true);
  CHECK_BOOL(first->SetFlag("clip", ""), true);
  CHECK_INT(static_cast<int>(first->GetFlags().count("clip")), 0);
  CHECK_EXIT_SUCCESS(testWithheld());
  CHECK_EXIT_SUCCESS(testUnknown());
  return EXIT_SUCCESS;
}
