#include "qSlicerFenestraImageClicks.h"

#include <qMRMLSliceView.h>
#include <qMRMLSliceWidget.h>
#include <qSlicerApplication.h>
#include <qSlicerLayoutManager.h>

#include <vtkMRMLInteractionNode.h>
#include <vtkMRMLScene.h>

#include <vtkCommand.h>

qSlicerFenestraImageClicks::qSlicerFenestraImageClicks(vtkSlicerFenestraLogic* logic,
                                                       QObject* parent)
    : QObject(parent), m_logic(logic) {
  qvtkConnect(logic, vtkSlicerFenestraLogic::ViewChangedEvent, this, SLOT(followView()));
}

void qSlicerFenestraImageClicks::followView() {
  const qSlicerApplication* application = qSlicerApplication::application();
  qSlicerLayoutManager* layout = application ? application->layoutManager() : nullptr;
  qMRMLSliceWidget* widget = layout ? layout->sliceWidget("Fenestra") : nullptr;
  vtkRenderWindowInteractor* interactor = widget ? widget->sliceView()->interactor() : nullptr;
  if (interactor == m_interactor)
    return;
  // After Slicer's own observers, which take the crosshair to the plane of the image.
  constexpr float priority = -1.0F;
  qvtkReconnect(m_interactor, interactor, vtkCommand::LeftButtonPressEvent, this, SLOT(onClick()),
                priority);
  qvtkReconnect(m_interactor, interactor, vtkCommand::MouseMoveEvent, this, SLOT(onMove()),
                priority);
  m_interactor = interactor;
}

void qSlicerFenestraImageClicks::onClick() {
  if (!m_interactor->GetShiftKey() && !m_interactor->GetControlKey())
    jump();
}

void qSlicerFenestraImageClicks::onMove() {
  if (m_interactor->GetShiftKey())
    jump();
}

void qSlicerFenestraImageClicks::jump() {
  vtkMRMLScene* scene = m_logic->GetMRMLScene();
  auto* interaction = vtkMRMLInteractionNode::SafeDownCast(
      scene ? scene->GetFirstNodeByClass("vtkMRMLInteractionNode") : nullptr);
  if (interaction && interaction->GetCurrentInteractionMode() == vtkMRMLInteractionNode::Place)
    return;
  const int* const position = m_interactor->GetEventPosition();
  m_logic->JumpSlicesToViewPoint(position[0], position[1]);
}
