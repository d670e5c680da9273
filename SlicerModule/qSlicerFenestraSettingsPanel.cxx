#include "qSlicerFenestraSettingsPanel.h"

#include "qFenestraProgram.h"
#include "qSlicerFenestraApplicationSettings.h"
#include "ui_qSlicerFenestraSettingsPanel.h"

#include <QDebug>
#include <QDir>
#include <QFileDialog>
#include <QFileInfo>
#include <QPointer>
#include <QSharedPointer>
#include <QThread>
#include <QTimer>

namespace settings = qSlicerFenestraApplicationSettings;

class qSlicerFenestraSettingsPanelPrivate : public Ui_qSlicerFenestraSettingsPanel {
public:
  QString executable, temporaryFolder; ///< stored; the texts may be invalid
  QPointer<qFenestraProgram> check;    ///< null: no check is running
};

qSlicerFenestraSettingsPanel::qSlicerFenestraSettingsPanel(QWidget* parent)
    : Superclass(parent), d_ptr(new qSlicerFenestraSettingsPanelPrivate) {
  using Panel = qSlicerFenestraSettingsPanel;
  Q_D(qSlicerFenestraSettingsPanel);
  d->setupUi(this);
  d->ThreadsBox->setMaximum(QThread::idealThreadCount());
  const QStringList devices = {"auto", "cpu", "gpu"}; // in the order of the texts
  for (int i = 0; i < devices.size(); ++i)
    d->DeviceBox->setItemData(i, devices[i]);
  connect(d->DeviceBox, QOverload<int>::of(&QComboBox::currentIndexChanged), this,
          [this] { emit deviceChanged(device()); });
  connect(d->ExecutableEdit, &QLineEdit::editingFinished, this, &Panel::checkExecutable);
  connect(d->TemporaryFolderEdit, &QLineEdit::editingFinished, this, &Panel::checkTemporaryFolder);
  const auto choose = [](QLineEdit* edit, const QString& path) {
    if (path.isEmpty()) // canceled
      return;
    edit->setText(QDir::toNativeSeparators(path));
    emit edit->editingFinished();
  };
  connect(d->ExecutableButton, &QToolButton::clicked, this, [this, d, choose] {
    choose(d->ExecutableEdit,
           QFileDialog::getOpenFileName(this, tr("Executable"), d->ExecutableEdit->text()));
  });
  connect(d->TemporaryFolderButton, &QToolButton::clicked, this, [this, d, choose] {
    choose(d->TemporaryFolderEdit,
           QFileDialog::getExistingDirectory(this, tr("Folder for temporary files"),
                                             d->TemporaryFolderEdit->text()));
  });
  registerProperty(settings::threadsKey, d->ThreadsBox, "value", SIGNAL(valueChanged(int)));
  registerProperty(settings::deviceKey, this, "device", SIGNAL(deviceChanged(QString)));
  registerProperty(settings::executableKey, this, "executable", SIGNAL(executableChanged(QString)));
  registerProperty(settings::temporaryFolderKey, this, "temporaryFolder",
                   SIGNAL(temporaryFolderChanged(QString)));
}

qSlicerFenestraSettingsPanel::~qSlicerFenestraSettingsPanel() = default;

QString qSlicerFenestraSettingsPanel::device() const {
  Q_D(const qSlicerFenestraSettingsPanel);
  return d->DeviceBox->currentData().toString();
}

void qSlicerFenestraSettingsPanel::setDevice(const QString& device) {
  Q_D(qSlicerFenestraSettingsPanel);
  d->DeviceBox->setCurrentIndex(qMax(0, d->DeviceBox->findData(device)));
}

QString qSlicerFenestraSettingsPanel::executable() const {
  Q_D(const qSlicerFenestraSettingsPanel);
  return d->executable;
}

void qSlicerFenestraSettingsPanel::setExecutable(const QString& executable) {
  Q_D(qSlicerFenestraSettingsPanel);
  delete d->check;
  d->ExecutableEdit->setText(QDir::toNativeSeparators(executable));
  d->ExecutableStateLabel->clear();
  if (executable == d->executable)
    return;
  d->executable = executable;
  emit executableChanged(executable);
}

QString qSlicerFenestraSettingsPanel::temporaryFolder() const {
  Q_D(const qSlicerFenestraSettingsPanel);
  return d->temporaryFolder;
}

void qSlicerFenestraSettingsPanel::setTemporaryFolder(const QString& folder) {
  Q_D(qSlicerFenestraSettingsPanel);
  d->TemporaryFolderEdit->setText(QDir::toNativeSeparators(folder));
  d->TemporaryFolderStateLabel->clear();
  if (folder == d->temporaryFolder)
    return;
  d->temporaryFolder = folder;
  emit temporaryFolderChanged(folder);
}

void qSlicerFenestraSettingsPanel::checkTemporaryFolder() {
  Q_D(qSlicerFenestraSettingsPanel);
  const QString folder = QDir::fromNativeSeparators(d->TemporaryFolderEdit->text().trimmed());
  if (folder.isEmpty() || settings::isUsableFolder(folder))
    return setTemporaryFolder(folder);
  d->TemporaryFolderStateLabel->setText(
      tr("Not used: this is no folder, or files cannot be written to it."));
}

void qSlicerFenestraSettingsPanel::checkExecutable() {
  Q_D(qSlicerFenestraSettingsPanel);
  const QString executable = QDir::fromNativeSeparators(d->ExecutableEdit->text().trimmed());
  if (executable.isEmpty())
    return setExecutable(executable);
  if (d->check && d->check->program() == executable)
    return;
  delete d->check;
  const QFileInfo info(executable);
  if (info.isAbsolute() && info.isFile() && info.isExecutable())
    return startCheck(executable);
  d->ExecutableStateLabel->setText(tr("Not used: this is no executable file."));
}

/// Asks the executable for its version, and ends it if it does not answer.
void qSlicerFenestraSettingsPanel::startCheck(const QString& executable) {
  Q_D(qSlicerFenestraSettingsPanel);
  constexpr int patience = 10000; // ms, on a busy machine
  d->ExecutableStateLabel->setText(tr("Checking..."));
  d->check = new qFenestraProgram(this);
  const auto version = QSharedPointer<QString>::create();
  connect(d->check, &qFenestraProgram::lineReceived, d->check, [version](const QString& line) {
    if (version->isEmpty())
      *version = line;
  });
  connect(d->check, &qFenestraProgram::ended, this,
          [this, executable, version](const qFenestraOutcome& outcome) {
            endCheck(executable, *version, outcome);
          });
  QTimer::singleShot(patience, d->check, [check = d->check.data()] {
    check->stop();
    check->stop(); // kills
  });
  d->check->run(executable, {"--version"}, QDir::tempPath());
}

void qSlicerFenestraSettingsPanel::endCheck(const QString& executable, const QString& version,
                                            const qFenestraOutcome& outcome) {
  Q_D(qSlicerFenestraSettingsPanel);
  d->check->deleteLater();
  d->check = nullptr;
  const bool isRenderer =
      outcome.kind == qFenestraOutcome::Kind::done && version.startsWith("fenestra ");
  if (isRenderer)
    setExecutable(executable);
  else
    qWarning().noquote() << "Fenestra:" << executable << "is not the renderer:" << outcome.message
                         << outcome.details;
  d->ExecutableStateLabel->setText(
      isRenderer ? version : tr("Not used: this is not the renderer, or it does not run."));
}
