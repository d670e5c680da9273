#ifndef __qSlicerFenestraLiveView_h
#define __qSlicerFenestraLiveView_h

#include "FenestraLiveState.h"
#include "qFenestraPreview.h"
#include "qSlicerFenestraModuleExport.h"

#include <QElapsedTimer>
#include <QTimer>

#include <ctkVTKObject.h>

#include <optional>

#include "vtkMRMLFenestraOpeningNode.h"
#include "vtkMRMLFenestraRenderNode.h"
#include "vtkSlicerFenestraLogic.h"
#include <vtkRenderWindow.h>
#include <vtkWeakPointer.h>

class qSlicerFenestraSession;
class vtkMRMLCameraNode;
class vtkMRMLViewNode;

/// \brief The path-traced image in a 3D view: requests images of the view's camera from the session
/// once it rests, and gives them to the node of the opened view, which the displayable manager
/// draws. Follows the 3D view of the settings, or else the first one.
class Q_SLICER_QTMODULES_FENESTRA_EXPORT qSlicerFenestraLiveView : public QObject {
  Q_OBJECT
  QVTK_OBJECT

public:
  qSlicerFenestraLiveView(vtkSlicerFenestraLogic* logic, qSlicerFenestraSession* session);

private slots:
  void onOpeningChanged();
  /// Turns on or off, and follows another view, as the node says.
  void update();
  void onViewChanged();
  void onDataChanged();

private:
  double now() const { return 1e-3 * static_cast<double>(m_clock.elapsed()); }
  void observe(vtkMRMLFenestraRenderNode* settings);
  bool followView(vtkMRMLFenestraRenderNode* settings);
  void advance();
  std::optional<FenestraViewCamera> takeCamera();
  void request();
  void receive(const qFenestraPreviewImage& picture);
  void showImage();
  void clearImage();

  vtkSlicerFenestraLogic* m_logic;
  qSlicerFenestraSession* m_session;
  SlicerExport::LiveState m_state;
  QElapsedTimer m_clock;
  QTimer m_timer;      ///< of the state
  QTimer m_retryTimer; ///< while there is no view or no volume

  vtkWeakPointer<vtkMRMLFenestraOpeningNode> m_opening; ///< observed, as all below
  vtkWeakPointer<vtkMRMLFenestraRenderNode> m_settings;
  vtkWeakPointer<vtkMRMLNode> m_volume, m_segmentation;
  vtkWeakPointer<vtkMRMLViewNode> m_view;
  vtkWeakPointer<vtkMRMLCameraNode> m_camera;
  vtkWeakPointer<vtkRenderWindow> m_window;
  FenestraViewCamera m_requested = {};                ///< camera of the last request
  FenestraViewCamera m_seen = {};                     ///< last camera of the view
  std::shared_ptr<const SlicerExport::Frame> m_frame; ///< the latest one
};

#endif
