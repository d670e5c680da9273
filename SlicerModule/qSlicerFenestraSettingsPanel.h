#ifndef __qSlicerFenestraSettingsPanel_h
#define __qSlicerFenestraSettingsPanel_h

#include <QScopedPointer>

#include <ctkSettingsPanel.h>

#include "qSlicerFenestraModuleExport.h"

struct qFenestraOutcome;
class qSlicerFenestraSettingsPanelPrivate;

/// \brief Page of Slicer's application settings: threads, device, executable and folder of
/// temporary files (qSlicerFenestraApplicationSettings).
///
/// An executable that the user chooses is started with `--version`; one that is not the renderer is
/// reported and not stored.
class Q_SLICER_QTMODULES_FENESTRA_EXPORT qSlicerFenestraSettingsPanel : public ctkSettingsPanel {
  Q_OBJECT
  Q_PROPERTY(QString device READ device WRITE setDevice NOTIFY deviceChanged)
  Q_PROPERTY(QString executable READ executable WRITE setExecutable NOTIFY executableChanged)
  Q_PROPERTY(QString temporaryFolder READ temporaryFolder WRITE setTemporaryFolder NOTIFY
                 temporaryFolderChanged)

public:
  typedef ctkSettingsPanel Superclass;
  explicit qSlicerFenestraSettingsPanel(QWidget* parent = nullptr);
  ~qSlicerFenestraSettingsPanel() override;

  QString device() const;
  QString executable() const;
  QString temporaryFolder() const;

public slots:
  void setDevice(const QString& device);
  /// Without a check.
  void setExecutable(const QString& executable);
  void setTemporaryFolder(const QString& folder);

signals:
  void deviceChanged(const QString& device);
  void executableChanged(const QString& executable);
  void temporaryFolderChanged(const QString& folder);

private slots:
  void checkExecutable();
  void checkTemporaryFolder();

protected:
  QScopedPointer<qSlicerFenestraSettingsPanelPrivate> d_ptr;

private:
  Q_DECLARE_PRIVATE(qSlicerFenestraSettingsPanel);
  Q_DISABLE_COPY(qSlicerFenestraSettingsPanel);

  void startCheck(const QString& executable);
  void endCheck(const QString& executable, const QString& version, const qFenestraOutcome& outcome);
};

#endif
