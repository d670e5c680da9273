#pragma once
// What the tutorial tells a user to do, done with the mouse, and what comes of it.

#include "qSlicerFenestraPulse.h"
#include "qSlicerFenestraUser.h"

#include <QJsonObject>

class vtkMRMLVolumeNode;

class qSlicerFenestraTour : private qSlicerFenestraUser {
public:
  /// `report`: a folder with the phantom's scene in knee/; pictures and tour.json are left there.
  explicit qSlicerFenestraTour(const QString& report);
  /// Whether every step did what the tutorial says.
  bool run();

private:
  bool loadPhantom();
  bool seeModule();
  bool chooseCartilage();
  bool turnCamera();
  int slowestTurn();
  void showVolumeRendering(bool visible);
  bool render();
  bool stopRender();
  bool changeClipping();
  bool changeView();
  bool renderMeasured();
  bool renderTurntable();
  bool saveAndRepeat();
  bool runCommand();
  void faceOutput(vtkMRMLVolumeNode* output);

  qSlicerFenestraPulse m_pulse;
  QJsonObject m_figures;
};
