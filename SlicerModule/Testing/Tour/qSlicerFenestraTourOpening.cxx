// The tour's steps in the opened view.

#include "qSlicerFenestraTour.h"

#include "qSlicerFenestraModuleWidget.h"
#include "vtkMRMLFenestraOpeningDisplayableManager.h"
#include "vtkMRMLFenestraOpeningNode.h"

#include <qMRMLThreeDView.h>
#include <qMRMLThreeDWidget.h>
#include <qSlicerApplication.h>
#include <qSlicerLayoutManager.h>

#include <vtkCamera.h>
#include <vtkCollection.h>
#include <vtkLineSource.h>
#include <vtkMRMLCameraNode.h>
#include <vtkMRMLModelDisplayNode.h>
#include <vtkMRMLModelNode.h>
#include <vtkMRMLScene.h>
#include <vtkMath.h>
#include <vtkNew.h>
#include <vtkRenderWindow.h>
#include <vtkTubeFilter.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>

namespace {

using Manager = vtkMRMLFenestraOpeningDisplayableManager;

qMRMLThreeDView* findView() {
  return qSlicerApplication::application()->layoutManager()->threeDWidget(0)->threeDView();
}

Manager* findManager() {
  vtkNew<vtkCollection> managers;
  findView()->getDisplayableManagers(managers);
  for (int i = 0; i < managers->GetNumberOfItems(); ++i)
    if (auto* manager = Manager::SafeDownCast(managers->GetItemAsObject(i)))
      return manager;
  return nullptr;
}

/// Colors of the 3D view, rendered now.
std::vector<unsigned char> photographView() {
  findView()->forceRender();
  vtkRenderWindow* window = findView()->renderWindow();
  const int* size = window->GetSize();
  vtkNew<vtkUnsignedCharArray> pixels;
  window->GetPixelData(0, 0, size[0] - 1, size[1] - 1, 0, pixels);
  return {pixels->GetPointer(0), pixels->GetPointer(0) + pixels->GetNumberOfValues()};
}

double findChangedFraction(const std::vector<unsigned char>& a,
                           const std::vector<unsigned char>& b) {
  if (a.size() != b.size() || a.empty())
    return 1.0;
  std::size_t changed = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    changed += std::abs(a[i] - b[i]) > 8 ? 1 : 0;
  return static_cast<double>(changed) / static_cast<double>(a.size());
}

vtkCamera* findCamera() {
  auto* node = vtkMRMLCameraNode::SafeDownCast(
      qSlicerApplication::application()->mrmlScene()->GetFirstNodeByClass("vtkMRMLCameraNode"));
  return node->GetCamera();
}

/// A model of a needle that enters the anatomy from the camera's side.
void addNeedle() {
  double tip[3], end[3];
  findCamera()->GetFocalPoint(tip);
  findCamera()->GetDirectionOfProjection(end);
  double right[3];
  vtkMath::Cross(end, findCamera()->GetViewUp(), right);
  constexpr double length = 120.0; // mm
  for (int axis = 0; axis < 3; ++axis)
    end[axis] = tip[axis] + length * (0.6 * right[axis] - 0.8 * end[axis]);
  vtkNew<vtkLineSource> line;
  line->SetPoint1(tip);
  line->SetPoint2(end);
  vtkNew<vtkTubeFilter> tube;
  tube->SetInputConnection(line->GetOutputPort());
  tube->SetRadius(1.5);
  tube->SetNumberOfSides(16);
  tube->CappingOn();
  tube->Update();
  auto* model = vtkMRMLModelNode::SafeDownCast(
      qSlicerApplication::application()->mrmlScene()->AddNewNodeByClass("vtkMRMLModelNode",
                                                                        "Needle"));
  model->SetAndObserveMesh(tube->GetOutput());
  model->CreateDefaultDisplayNodes();
  model->GetDisplayNode()->SetColor(0.2, 0.8, 1.0);
}

} // namespace

/// Opens the view, turns it, and closes it: the image is then the former one.
bool qSlicerFenestraTour::openView() {
  showVolumeRendering(true);
  Manager* const manager = findManager();
  const std::vector<unsigned char> before = photographView();
  m_pulse.start();
  QElapsedTimer watch;
  watch.start();
  if (!manager || !click("OpenButton") || !waitFor([&] { return manager->IsOpened(); }))
    return false;
  m_measurements["openingMs"] = static_cast<int>(watch.elapsed());
  wait(3000);
  const double opened = findChangedFraction(before, photographView());
  m_measurements["changedByOpening"] = opened;
  takeScreenshot("19-view-opened");
  double slowest = 0.0;
  for (int turn = 0; turn < 10; ++turn) {
    findCamera()->Azimuth(6.0);
    findView()->forceRender();
    slowest = std::max(slowest, manager->GetSeconds());
  }
  m_measurements["slowestSurfaceMs"] = 1000.0 * slowest;
  wait(3000);
  takeScreenshot("20-view-turned");
  findCamera()->Azimuth(-60.0);
  if (!click("OpenButton") || !waitFor([&] { return !manager->IsOpened(); }))
    return false;
  wait(1000);
  const double closed = findChangedFraction(before, photographView());
  m_measurements["changedByClosing"] = closed;
  return opened > 0.01 && closed < 1e-3; // the camera turned back with rounding
}

/// Shows the path-traced image of the opened view while it rests, with a needle in the anatomy.
bool qSlicerFenestraTour::restView() {
  Manager* const manager = findManager();
  if (!manager || !click("OpenButton") || !waitFor([&] { return manager->IsOpened(); }))
    return false;
  addNeedle();
  wait(2000);
  m_pulse.start();
  QElapsedTimer watch;
  watch.start();
  if (!click("PhotorealisticButton") || !waitFor([&] { return manager->IsImageShown(); }))
    return false;
  m_measurements["firstImageMs"] = static_cast<int>(watch.elapsed());
  findView()->forceRender();
  takeScreenshot("21-view-resting");
  wait(20000);
  takeScreenshot("22-view-photorealistic");
  findCamera()->Azimuth(20.0);
  findView()->forceRender();
  const bool isHidden = !manager->IsImageShown();
  watch.start();
  if (!waitFor([&] { return manager->IsImageShown(); }))
    return false;
  m_measurements["nextImageMs"] = static_cast<int>(watch.elapsed());
  wait(20000);
  takeScreenshot("23-view-turned-photorealistic");
  findCamera()->Azimuth(-20.0);
  if (!click("PhotorealisticButton") || !waitFor([&] { return !manager->IsImageShown(); }))
    return false;
  return isHidden && click("OpenButton") && waitFor([&] { return !manager->IsOpened(); });
}
