// Opens the view on a segment, and follows its edits, saving, loading and closing of the scene.
// Arguments: the renderer, a folder for files, the module's library.

#include "FenestraPanel.h"
#include "FenestraTesting.h"

#include "vtkMRMLFenestraOpeningNode.h"

#include <vtkMRMLVolumeRenderingDisplayNode.h>

#include <QLabel>
#include <QPushButton>

namespace {

using FenestraTesting::Panel;
using FenestraTesting::waitFor;
using Node = vtkMRMLFenestraRenderNode;
using Opening = vtkMRMLFenestraOpeningNode;

/// Largest distance of the focus from the ball's center, mm; -1: there is no focus.
double findRadius(Opening* opening) {
  double radius = -1.0;
  if (opening->HasFocus())
    for (size_t i = 0; i < opening->GetFocus()->points().size(); i += 3) {
      const float* point = &opening->GetFocus()->points()[i];
      radius = std::max(radius, std::hypot(double{point[0]}, double{point[1]}, double{point[2]}));
    }
  return radius;
}

bool isNearRadius(Opening* opening, double expected) {
  return std::abs(findRadius(opening) - expected) < 1.0;
}

int open(const Panel& panel, vtkMRMLScene* scene) {
  auto* button = panel.find<QPushButton>("OpenButton");
  CHECK_BOOL(button->isEnabled(), false); // no focus yet
  TESTING_OUTPUT_ASSERT_ERRORS_BEGIN();
  CHECK_NULL(panel.logic->OpenView(panel.settings()));
  CHECK_NULL(panel.logic->OpenView(nullptr));
  TESTING_OUTPUT_ASSERT_ERRORS_END();
  panel.settings()->SetFocus("Ball");
  CHECK_BOOL(waitFor([&] { return button->isEnabled(); }), true);
  button->click();
  Opening* opening = panel.logic->GetOpening();
  CHECK_NOT_NULL(opening);
  CHECK_BOOL(opening->GetVisible(), true);
  auto* display = vtkMRMLVolumeRenderingDisplayNode::SafeDownCast(
      scene->GetFirstNodeByClass("vtkMRMLVolumeRenderingDisplayNode"));
  CHECK_BOOL(!display || display->GetVisibility(), true); // none without that module
  CHECK_BOOL(waitFor([&] { return opening->HasFocus(); }), true);
  CHECK_BOOL(isNearRadius(opening, 10.0), true);
  const auto& corners = opening->GetVolumeCorners(); // half a voxel beyond the centers
  CHECK_DOUBLE_TOLERANCE(corners[0][0], -16.5, 1e-9);
  CHECK_DOUBLE_TOLERANCE(corners[7][2], 15.5, 1e-9);
  CHECK_STD_STRING(panel.find<QLabel>("OpeningStateLabel")->text().toStdString(), "");
  return EXIT_SUCCESS;
}

/// Margins and edits of the segment, and a segment that is removed and comes back.
int followEdits(const Panel& panel, vtkMRMLSegmentationNode* segmentation) {
  Opening* opening = panel.logic->GetOpening();
  panel.settings()->SetFlag("margin", "-3");
  CHECK_BOOL(waitFor([&] { return isNearRadius(opening, 7.0); }), true);
  panel.settings()->SetFlag("margin", "");
  CHECK_BOOL(waitFor([&] { return isNearRadius(opening, 10.0); }), true);
  panel.settings()->SetFocus("Nothing");
  CHECK_BOOL(waitFor([&] { return !opening->GetProblem().empty(); }), true);
  CHECK_BOOL(opening->HasFocus(), false);
  CHECK_STD_STRING(panel.find<QLabel>("OpeningStateLabel")->text().toStdString(),
                   opening->GetProblem());
  CHECK_NOT_NULL(
      panel.logic->OpenSegment(segmentation, panel.logic->GetSegmentIDs(panel.settings())[0]));
  CHECK_BOOL(waitFor([&] { return isNearRadius(opening, 10.0); }), true);
  CHECK_STD_STRING(opening->GetProblem(), "");
  return EXIT_SUCCESS;
}

/// A clip mode that the view cannot show is a problem, and one that it can show is none.
int explainModes(const Panel& panel) {
  Opening* opening = panel.logic->GetOpening();
  panel.settings()->SetFlag("clip", "hole");
  CHECK_BOOL(waitFor([&] { return !opening->GetProblem().empty(); }), true);
  CHECK_BOOL(opening->HasFocus(), true);
  panel.settings()->SetFlag("clip", "cutaway");
  CHECK_BOOL(waitFor([&] { return opening->GetProblem().empty(); }), true);
  return EXIT_SUCCESS;
}

/// The triangles of a segmentation whose layers have different grids are made once.
int settleWithTwoGrids(const Panel& panel, vtkMRMLSegmentationNode* segmentation) {
  Opening* opening = panel.logic->GetOpening();
  vtkNew<vtkOrientedImageData> labels;
  FenestraTesting::fillBall(labels, VTK_UNSIGNED_CHAR, 1.0);
  labels->SetOrigin(-12.5, -16.0, -16.0);
  segmentation->AddSegmentFromBinaryLabelmapRepresentation(labels, "Shifted");
  CHECK_BOOL(waitFor([&] { return opening->GetPreparing(); }), true);
  CHECK_BOOL(waitFor([&] { return !opening->GetPreparing(); }), true);
  QElapsedTimer watch;
  watch.start();
  waitFor([&] { return opening->GetPreparing() || watch.elapsed() > 1000; });
  CHECK_BOOL(opening->GetPreparing(), false);
  segmentation->RemoveSegment("Shifted");
  return EXIT_SUCCESS;
}

/// Another volume is not cut by the former one's focus.
int changeVolume(const Panel& panel, vtkMRMLScene* scene) {
  Opening* opening = panel.logic->GetOpening();
  CHECK_BOOL(waitFor([&] { return opening->HasFocus() && !opening->GetPreparing(); }), true);
  vtkMRMLScalarVolumeNode* before =
      vtkMRMLScalarVolumeNode::SafeDownCast(panel.settings()->GetNodeReference(Node::VolumeRole));
  CHECK_NOT_NULL(panel.logic->OpenVolume(FenestraTesting::addVolume(scene)));
  CHECK_BOOL(waitFor([&] { return opening->GetPreparing(); }), true);
  CHECK_BOOL(opening->HasFocus(), false);
  CHECK_BOOL(waitFor([&] { return isNearRadius(opening, 10.0); }), true);
  CHECK_NOT_NULL(panel.logic->OpenVolume(before));
  CHECK_BOOL(waitFor([&] { return opening->GetPreparing(); }), true);
  CHECK_BOOL(waitFor([&] { return isNearRadius(opening, 10.0); }), true);
  return EXIT_SUCCESS;
}

/// A hidden opened view does no work; the box shows the state that a script sets.
int closeAndReopen(const Panel& panel) {
  Opening* opening = panel.logic->GetOpening();
  panel.logic->CloseView();
  CHECK_BOOL(panel.find<QPushButton>("OpenButton")->isChecked(), false);
  panel.settings()->SetFlag("margin", "-3");
  CHECK_BOOL(isNearRadius(opening, 10.0), true);
  CHECK_NOT_NULL(panel.logic->OpenView(panel.settings()));
  CHECK_BOOL(panel.find<QPushButton>("OpenButton")->isChecked(), true);
  CHECK_BOOL(waitFor([&] { return isNearRadius(opening, 7.0); }), true);
  return EXIT_SUCCESS;
}

int saveAndLoad(const Panel& panel, vtkMRMLScene* scene) {
  scene->SetSaveToXMLString(1);
  scene->Commit();
  const std::string saved = scene->GetSceneXMLString();
  panel.logic->GetOpening()->SetVisible(false);
  CHECK_BOOL(saved.find("<FenestraOpening") != std::string::npos, true);
  CHECK_BOOL(saved.find("visible=\"true\"") != std::string::npos, true);
  scene->Clear(0); // while the opened view exists
  CHECK_NULL(panel.logic->GetOpening());
  CHECK_BOOL(waitFor([&] { return !panel.find<QPushButton>("OpenButton")->isChecked(); }), true);
  return EXIT_SUCCESS;
}

/// Adds a ball and its segment, and opens the view on it.
void addAndOpen(const Panel& panel, vtkMRMLScene* scene, const char* margin) {
  auto* volume = FenestraTesting::addVolume(scene);
  auto* segmentation = FenestraTesting::addSegmentation(scene);
  panel.settings()->SetNodeReferenceID(Node::VolumeRole, volume->GetID());
  panel.settings()->SetNodeReferenceID(Node::SegmentationRole, segmentation->GetID());
  panel.settings()->SetFlag("margin", margin);
  panel.settings()->SetFocus("Ball");
  panel.logic->OpenView(panel.settings());
}

/// The focus of a scene that was closed while it was prepared is not that of the next scene.
int closeWhilePreparing(const Panel& panel, vtkMRMLScene* scene) {
  addAndOpen(panel, scene, "-5");
  CHECK_BOOL(waitFor([&] { return panel.logic->GetOpening()->GetPreparing(); }), true);
  scene->Clear(0);
  addAndOpen(panel, scene, "");
  Opening* opening = panel.logic->GetOpening();
  CHECK_BOOL(waitFor([&] { return opening->HasFocus(); }), true);
  CHECK_BOOL(isNearRadius(opening, 10.0), true);
  CHECK_BOOL(waitFor([&] { return !opening->GetPreparing(); }), true);
  CHECK_BOOL(isNearRadius(opening, 10.0), true);
  return EXIT_SUCCESS;
}

} // namespace

int qSlicerFenestraOpeningTest1(int argc, char* argv[]) {
  FenestraTesting::Slicer slicer(argc, argv);
  FenestraTesting::registerConverters();
  const Panel& panel = slicer.panel;
  auto* volume = FenestraTesting::addVolume(slicer.scene);
  auto* segmentation = FenestraTesting::addSegmentation(slicer.scene);
  slicer.owner->enter();
  panel.settings()->SetNodeReferenceID(Node::VolumeRole, volume->GetID());
  panel.settings()->SetNodeReferenceID(Node::SegmentationRole, segmentation->GetID());
  CHECK_EXIT_SUCCESS(open(panel, slicer.scene));
  CHECK_EXIT_SUCCESS(followEdits(panel, segmentation));
  CHECK_EXIT_SUCCESS(explainModes(panel));
  CHECK_EXIT_SUCCESS(settleWithTwoGrids(panel, segmentation));
  CHECK_EXIT_SUCCESS(changeVolume(panel, slicer.scene));
  CHECK_EXIT_SUCCESS(closeAndReopen(panel));
  CHECK_EXIT_SUCCESS(saveAndLoad(panel, slicer.scene));
  CHECK_EXIT_SUCCESS(closeWhilePreparing(panel, slicer.scene));
  return EXIT_SUCCESS;
}
