#pragma once
// Simulated user of the panel: mouse actions, screenshots, and access to the scene's nodes.

#include <QString>

#include <functional>

class QMainWindow;
class qSlicerFenestraModuleWidget;
class vtkMRMLFenestraRenderNode;

class qSlicerFenestraUser {
public:
  /// `report`: folder for screenshots.
  explicit qSlicerFenestraUser(const QString& report);

protected:
  /// Opens the module and starts counting previews and renders.
  bool openModule();

  bool click(const char* button);
  bool choose(const char* box, const QString& data);
  void set(const char* box, double value);
  void scrollTo(const char* widget);
  void fold(const char* section, bool folded);
  bool waitFor(const std::function<bool()>& condition, int milliseconds = 60000);
  void wait(int milliseconds);
  void takeScreenshot(const char* name);
  bool takePreviewScreenshot(const char* name, const std::function<bool()>& action);

  vtkMRMLFenestraRenderNode* settings() const;
  vtkMRMLFenestraRenderNode* firstRender() const;
  vtkMRMLFenestraRenderNode* lastRender() const; ///< last render with an image

  QString m_report;
  QMainWindow* m_window;
  qSlicerFenestraModuleWidget* m_panel = nullptr;
  int m_previews = 0;
  int m_ended = 0; ///< renders ended
};
