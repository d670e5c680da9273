#ifndef __qSlicerFenestraImageClicks_h
#define __qSlicerFenestraImageClicks_h

#include "vtkSlicerFenestraLogic.h"

#include <ctkVTKObject.h>

#include <QObject>
#include <QPoint>

#include <optional>

#include <vtkRenderWindowInteractor.h>
#include <vtkWeakPointer.h>

/// \brief Takes the slice views and the crosshair to the anatomy that a shown image has under the
/// mouse: at a click, and at each move with Shift, as in Slicer's own views. Where the image shows
/// nothing, they stay at the last point.
class qSlicerFenestraImageClicks : public QObject {
  Q_OBJECT
  QVTK_OBJECT

public:
  qSlicerFenestraImageClicks(vtkSlicerFenestraLogic* logic, QObject* parent);

private slots:
  void onViewChanged();
  void onPress();
  void onRelease();
  void onMove();

private:
  /// Follows the view of images once the layout has created it.
  void followView();
  QPoint mousePosition() const; ///< pixels, from the lower left
  bool jump(const QPoint& to);

  vtkSlicerFenestraLogic* m_logic;
  vtkWeakPointer<vtkRenderWindowInteractor> m_interactor; ///< of that view; null: none yet
  std::optional<QPoint> m_pressed;                        ///< where a click has begun
  std::optional<QPoint> m_last;                           ///< where the image showed something
};

#endif
