// Closes and loads a scene while the panel is open, replacing the current scene or adding to it.
// Arguments: the renderer, a folder for files, the module's library.

#include "FenestraPanel.h"
#include "FenestraTesting.h"

#include <QLabel>
#include <QListWidget>
#include <QPushButton>
#include <QSpinBox>
#include <QTableWidget>

#include <vtkCacheManager.h>
#include <vtkCollection.h>
#include <vtkMRMLApplicationLogic.h>
#include <vtkMRMLLayoutNode.h>
#include <vtkMRMLSliceLogic.h>

namespace {

using FenestraTesting::endsOneRender;
using FenestraTesting::Panel;
using FenestraTesting::waitFor;
using Node = vtkMRMLFenestraRenderNode;

std::string labelText(const Panel& panel, const char* label) {
  return panel.find<QLabel>(label)->text().toStdString();
}

bool hasPreview(const Panel& panel) {
  return labelText(panel, "PreviewStateLabel").find("samples per pixel") != std::string::npos;
}

/// Adds the view that Slicer's layout manager would create for ShowResult.
void addPictureView(vtkMRMLApplicationLogic* application, vtkMRMLScene* scene) {
  scene->AddNewNodeByClass("vtkMRMLLayoutNode");
  vtkNew<vtkMRMLSliceLogic> view;
  view->SetMRMLScene(scene);
  view->AddSliceNode("Fenestra");
  vtkNew<vtkCollection> views;
  views->AddItem(view);
  application->SetSliceLogics(views);
}

vtkMRMLLayoutNode* findLayout(vtkMRMLScene* scene) {
  return vtkMRMLLayoutNode::SafeDownCast(scene->GetFirstNodeByClass("vtkMRMLLayoutNode"));
}

/// Back restores the views from before the first image that was shown.
int checkBack(const Panel& panel, vtkMRMLScene* scene) {
  panel.find<QPushButton>("BackButton")->click();
  CHECK_NULL(panel.logic->GetShownRender());
  CHECK_BOOL(panel.find<QPushButton>("BackButton")->isEnabled(), false);
  CHECK_INT(findLayout(scene)->GetViewArrangement(), vtkMRMLLayoutNode::SlicerLayoutOneUp3DView);
  return EXIT_SUCCESS;
}

QComboBox* findMaterial(const Panel& panel, int row) {
  return qobject_cast<QComboBox*>(panel.find<QTableWidget>("MaterialsTable")->cellWidget(row, 1));
}

/// Gives the ball another material, once the renderer has reported its automatic choice.
int chooseMaterial(const Panel& panel) {
  CHECK_INT(panel.find<QTableWidget>("MaterialsTable")->rowCount(), 2);
  QComboBox& material = *findMaterial(panel, 0);
  CHECK_BOOL(waitFor([&] { return material.count() > 20; }), true);
  material.setCurrentIndex(material.findData("spleen"));
  CHECK_STD_STRING(panel.flag("materials"), "library");
  CHECK_STD_STRING(panel.flag("material"), panel.settings()->GetFocus()[0] + ": material=spleen");
  return EXIT_SUCCESS;
}

int render(const Panel& panel, const char* from) {
  panel.choose("ViewBox", from);
  CHECK_BOOL(endsOneRender(panel, [&] { panel.find<QPushButton>("RenderButton")->click(); }), true);
  CHECK_NOT_NULL(panel.chosenRender());
  CHECK_BOOL(waitFor([&] { return panel.logic->GetShownRender() == panel.chosenRender(); }), true);
  CHECK_BOOL(panel.find<QPushButton>("BackButton")->isEnabled(), true);
  return EXIT_SUCCESS;
}

/// No text and no image of the scene remains.
int checkClosed(const Panel& panel) {
  for (const char* label : {"StateLabel", "PreviewStateLabel", "DescriptionLabel"})
    CHECK_STD_STRING(labelText(panel, label), "");
  CHECK_BOOL(panel.find<QLabel>("PreviewLabel")->text().startsWith("Load a volume"), true);
  for (const char* widget : {"DetailsButton", "ProgressBar", "MeasuresLabel", "Player"})
    CHECK_BOOL(panel.isShown(widget), false);
  CHECK_NULL(panel.chosenRender());
  return EXIT_SUCCESS;
}

/// The scene is as saved, and the displayed image is the chosen one.
int checkLoaded(const Panel& panel, vtkMRMLScene* scene) {
  vtkMRMLNode* volume = scene->GetFirstNodeByName("Ball");
  vtkMRMLNode* segmentation = scene->GetFirstNodeByName("Segmentation");
  CHECK_NOT_NULL(volume);
  CHECK_NOT_NULL(segmentation);
  CHECK_POINTER(panel.nodes("VolumeBox")->currentNode(), volume);
  CHECK_POINTER(panel.nodes("SegmentationBox")->currentNode(), segmentation);
  CHECK_POINTER(panel.settings()->GetNodeReference(Node::VolumeRole), volume);
  CHECK_POINTER(panel.settings()->GetNodeReference(Node::SegmentationRole), segmentation);
  QListWidget& focus = *panel.find<QListWidget>("FocusList");
  CHECK_INT(focus.count(), 2);
  CHECK_INT(focus.item(0)->checkState(), Qt::Checked);
  CHECK_STD_STRING(panel.flag("size"), "48x40");
  CHECK_STD_STRING(panel.chosen("MaterialsBox").toStdString(), "hand");
  CHECK_STD_STRING(panel.flag("materials"), "library");
  CHECK_STD_STRING(findMaterial(panel, 0)->currentData().toString().toStdString(), "spleen");
  CHECK_BOOL(panel.find<QPushButton>("RenderButton")->isEnabled(), true);
  CHECK_STD_STRING(labelText(panel, "StateLabel"), "");
  CHECK_POINTER(panel.chosenRender(), scene->GetFirstNodeByName("Ball render"));
  CHECK_POINTER(panel.logic->GetShownRender(), panel.chosenRender());
  CHECK_BOOL(panel.find<QLabel>("DescriptionLabel")->text().contains("samples"), true);
  CHECK_BOOL(waitFor([&] { return hasPreview(panel); }), true);
  return EXIT_SUCCESS;
}

/// Closing the scene stops its renders, including waiting ones.
int checkEnd(const Panel& panel, vtkMRMLScene* scene, qSlicerFenestraSession* session) {
  panel.find<QSpinBox>("SamplesBox")->setValue(1000000);
  panel.find<QPushButton>("RenderButton")->click();
  panel.find<QPushButton>("RenderButton")->click();
  CHECK_INT(session->waitingCount(), 1);
  CHECK_BOOL(waitFor([&] { return panel.isShown("ProgressBar"); }), true);
  scene->Clear(false);
  CHECK_BOOL(waitFor([&] { return !session->isRendering(); }), true);
  CHECK_STD_STRING(labelText(panel, "StateLabel"), "Stopped immediately, without an image.");
  CHECK_BOOL(panel.isShown("ProgressBar"), false);
  return EXIT_SUCCESS;
}

} // namespace

int qSlicerFenestraReloadTest1(int argc, char* argv[]) {
  const FenestraTesting::Slicer slicer(argc, argv);
  const Panel& panel = slicer.panel;
  vtkMRMLScene* scene = slicer.scene;
  FenestraTesting::registerConverters();
  scene->GetCacheManager()->SetRemoteCacheDirectory(argv[2]);
  addPictureView(slicer.application.applicationLogic(), scene);
  findLayout(scene)->SetViewArrangement(vtkMRMLLayoutNode::SlicerLayoutOneUp3DView);
  FenestraTesting::addVolume(scene);
  FenestraTesting::addSegmentation(scene);
  panel.widget->enter();
  panel.find<QListWidget>("FocusList")->item(0)->setCheckState(Qt::Checked);
  CHECK_EXIT_SUCCESS(chooseMaterial(panel));
  panel.choose("TransferBox", "ct-soft");
  panel.find<QSpinBox>("SamplesBox")->setValue(8);
  panel.find<QSpinBox>("WidthBox")->setValue(48);
  panel.find<QSpinBox>("HeightBox")->setValue(40);

  // Two images; the chosen one is displayed, and saved as such.
  CHECK_EXIT_SUCCESS(render(panel, "left"));
  Node* const first = panel.chosenRender();
  CHECK_EXIT_SUCCESS(render(panel, "right"));
  CHECK_BOOL(panel.chosenRender() != first, true);
  panel.nodes("RendersBox")->setCurrentNode(first);
  CHECK_BOOL(waitFor([&] { return panel.logic->GetShownRender() == first; }), true);
  CHECK_BOOL(labelText(panel, "StateLabel").rfind("Done:", 0) == 0, true);
  CHECK_BOOL(waitFor([&] { return hasPreview(panel); }), true);
  CHECK_EXIT_SUCCESS(checkBack(panel, scene));
  panel.find<QPushButton>("ShowButton")->click();
  CHECK_BOOL(waitFor([&] { return panel.logic->GetShownRender() == first; }), true);
  const std::string file = std::string(argv[2]) + "/reload.mrb";
  CHECK_BOOL(scene->WriteToMRB(file.c_str()), true);

  scene->Clear(false);
  CHECK_EXIT_SUCCESS(checkClosed(panel));
  scene->RemoveNode(findLayout(scene)); // like a new Slicer
  scene->AddNewNodeByClass("vtkMRMLLayoutNode");
  CHECK_BOOL(scene->ReadFromMRB(file.c_str(), false), true);
  CHECK_EXIT_SUCCESS(checkLoaded(panel, scene));
  CHECK_EXIT_SUCCESS(checkBack(panel, scene));
  CHECK_EXIT_SUCCESS(render(panel, "right")); // its messages must disappear, too
  panel.nodes("RendersBox")->setCurrentNode(nullptr);
  CHECK_BOOL(scene->ReadFromMRB(file.c_str(), true), true);
  CHECK_EXIT_SUCCESS(checkLoaded(panel, scene));
  scene->Clear(false);
  CHECK_EXIT_SUCCESS(checkClosed(panel));

  CHECK_BOOL(scene->ReadFromMRB(file.c_str(), true), true);
  CHECK_EXIT_SUCCESS(checkEnd(panel, scene, panel.widget->session()));
  panel.widget->exit();
  return EXIT_SUCCESS;
}
