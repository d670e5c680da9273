#ifndef __qSlicerFenestraOpening_h
#define __qSlicerFenestraOpening_h

#include <QWidget>

#include <ctkVTKObject.h>
#include <vtkWeakPointer.h>

class QPushButton;
class QLabel;
class vtkMRMLFenestraOpeningNode;
class vtkMRMLFenestraRenderNode;
class vtkSlicerFenestraLogic;

/// \brief Opens and closes the 3D views, and shows why they are not opened. Shows and hides the
/// path-traced image in a 3D view.
class qSlicerFenestraOpening : public QWidget {
  Q_OBJECT
  QVTK_OBJECT

public:
  explicit qSlicerFenestraOpening(QWidget* parent = nullptr);

  void setLogic(vtkSlicerFenestraLogic* logic);
  /// Settings with which the views are opened. Call again when they have changed.
  void use(vtkMRMLFenestraRenderNode* settings);

private slots:
  void onOpeningChanged();
  void updateWidgetFromMRML();

private:
  void onClicked(bool isOpen);

  vtkSlicerFenestraLogic* m_logic = nullptr;
  vtkWeakPointer<vtkMRMLFenestraRenderNode> m_settings;
  vtkWeakPointer<vtkMRMLFenestraOpeningNode> m_opening;
  QPushButton *m_button, *m_image;
  QLabel* m_state;
};

#endif
