#pragma once
// Performs the steps of the tutorial with the mouse and checks their results.

#include "qSlicerFenestraPulse.h"
#include "qSlicerFenestraUser.h"

#include <QJsonObject>

class vtkMRMLVolumeNode;

class qSlicerFenestraTour : private qSlicerFenestraUser {
public:
  /// `report`: folder with the phantom's scene in knee/; receives screenshots and tour.json.
  explicit qSlicerFenestraTour(const QString& report);
  /// True if every step had the result that the tutorial states.
  bool run();

private:
  bool loadPhantom();
  bool showModule();
  bool chooseCartilage();
  bool turnCamera();
  int slowestTurn();
  void showVolumeRendering(bool visible);
  bool openView();
  bool restView();
  bool render();
  bool stopRender();
  bool changeClipping();
  bool changeView();
  bool renderMeasured();
  bool renderTurntable();
  bool saveAndRepeat();
  bool runCommand();
  void alignViewWithOutput(vtkMRMLVolumeNode* output);

  qSlicerFenestraPulse m_pulse;
  QJsonObject m_measurements;
};
