#pragma once
// What the tutorial tells a user to do, done with the mouse, and what comes of it.

#include <QElapsedTimer>
#include <QJsonObject>
#include <QString>
#include <QTimer>

#include <functional>

class QMainWindow;
class qSlicerFenestraModuleWidget;
class vtkMRMLFenestraRenderNode;

/// The longest time that the event loop did not run.
class qSlicerFenestraPulse {
public:
  qSlicerFenestraPulse();
  void start() { m_longest = 0, m_watch.start(); }
  int longest() const { return static_cast<int>(m_longest); } ///< milliseconds

private:
  QTimer m_timer;
  QElapsedTimer m_watch;
  qint64 m_longest = 0;
};

class qSlicerFenestraTour {
public:
  /// `report`: a folder with the phantom's scene in knee/; pictures and tour.json are left there.
  explicit qSlicerFenestraTour(const QString& report);
  /// Whether every step did what the tutorial says.
  bool run();

private:
  bool loadPhantom();
  bool openModule();
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

  bool click(const char* button);
  bool choose(const char* box, const QString& data);
  void set(const char* box, double value);
  void scrollTo(const char* widget);
  void fold(const char* section, bool folded);
  bool photographPreview(const char* name, const std::function<bool()>& action);
  bool waitFor(const std::function<bool()>& condition, int milliseconds = 60000);
  void settle(int milliseconds);
  void photograph(const char* name);
  vtkMRMLFenestraRenderNode* settings() const;
  vtkMRMLFenestraRenderNode* firstRender() const;
  vtkMRMLFenestraRenderNode* lastRender() const;

  QString m_report;
  QMainWindow* m_window = nullptr;
  qSlicerFenestraModuleWidget* m_panel = nullptr;
  qSlicerFenestraPulse m_pulse;
  QJsonObject m_figures;
  int m_previews = 0;
  int m_ended = 0;
};
