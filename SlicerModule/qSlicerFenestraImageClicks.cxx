#include "qSlicerFenestraImageClicks.h"

#include <qMRMLSliceView.h>
#include <qMRMLSliceWidget.h>
#include <qSlicerApplication.h>
#include <qSlicerLayoutManager.h>

#include <vtkMRMLInteractionNode.h>
#include <vtkMRMLScene.h>

#include <vtkCommand.h>

#include <QTimer>

qSlicerFenestraImageClicks::qSlicerFenestraImageClicks(vtkSlicerFenestraLogic* logic,
                                                       QObject* parent)
    : QObject(parent), m_logic(logic) {
  qvtkConnect(logic, vtkSlicerFenestraLogic::ViewChangedEvent, this, SLOT(onViewChanged()));
}

void qSlicerFenestraImageClicks::onViewChanged() {
  QTimer::singleShot(0, this, [this] { followView(); }); // after the layout has changed
}

void qSlicerFenestraImageClicks::followView() {
  m_last.reset(); // maybe of another image
  const qSlicerApplication* application = qSlicerApplication::application();
  qSlicerLayoutManager* layout = application ? application->layoutManager() : nullptr;
  qMRMLSliceWidget* widget = layout ? layout->sliceWidget("Fenestra") : nullptr;
  vtkRenderWindowInteractor* interactor = widget ? widget->sliceView()->interactor() : nullptr;
  if (interactor == m_interactor)
    return;
  // After Slicer's own observers, which take the crosshair to the plane of the image.
  constexpr float priority = -1.0F;
  qvtkReconnect(m_interactor, interactor, vtkCommand::LeftButtonPressEvent, this, SLOT(onPress()),
                priority);
  qvtkReconnect(m_interactor, interactor, vtkCommand::LeftButtonReleaseEvent, this,
                SLOT(onRelease()), priority);
  qvtkReconnect(m_interactor, interactor, vtkCommand::MouseMoveEvent, this, SLOT(onMove()),
                priority);
  m_interactor = interactor;
}

QPoint qSlicerFenestraImageClicks::mousePosition() const {
  const int* const position = m_interactor->GetEventPosition();
  return {position[0], position[1]};
}

void qSlicerFenestraImageClicks::onPress() {
  m_pressed.reset();
  if (!m_interactor->GetShiftKey() && !m_interactor->GetControlKey())
    m_pressed = mousePosition();
}

/// A drag, of a markup's point for example, is no click.
void qSlicerFenestraImageClicks::onRelease() {
  if (m_pressed && m_pressed == mousePosition())
    jump(*m_pressed);
  m_pressed.reset();
}

void qSlicerFenestraImageClicks::onMove() {
  if (m_interactor->GetShiftKey() && !jump(mousePosition()) && m_last)
    jump(*m_last);
}

bool qSlicerFenestraImageClicks::jump(const QPoint& to) {
  vtkMRMLScene* scene = m_logic->GetMRMLScene();
  auto* interaction = vtkMRMLInteractionNode::SafeDownCast(
      scene ? scene->GetFirstNodeByClass("vtkMRMLInteractionNode") : nullptr);
  const bool isPlacing =
      interaction && interaction->GetCurrentInteractionMode() == vtkMRMLInteractionNode::Place;
  if (isPlacing || !m_logic->JumpSlicesToViewPoint(to.x(), to.y()))
    return false;
  m_last = to;
  return true;
}
