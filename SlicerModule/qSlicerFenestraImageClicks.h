#ifndef __qSlicerFenestraImageClicks_h
#define __qSlicerFenestraImageClicks_h

#include "vtkSlicerFenestraLogic.h"

#include <ctkVTKObject.h>

#include <QObject>

#include <vtkRenderWindowInteractor.h>
#include <vtkWeakPointer.h>

/// \brief Takes the slice views and the crosshair to the anatomy that a shown image has under the
/// mouse: at a click, and at each move with Shift, as in Slicer's own views.
class qSlicerFenestraImageClicks : public QObject {
  Q_OBJECT
  QVTK_OBJECT

public:
  qSlicerFenestraImageClicks(vtkSlicerFenestraLogic* logic, QObject* parent);

private slots:
  /// Follows the view of images once the layout has created it.
  void followView();
  void onClick();
  void onMove();

private:
  void jump();

  vtkSlicerFenestraLogic* m_logic;
  vtkWeakPointer<vtkRenderWindowInteractor> m_interactor; ///< of that view; null: none yet
};

#endif
