#include "qSlicerFenestraApplicationSettings.h"

#include <qSlicerCoreApplication.h>

#include <QDebug>
#include <QDir>
#include <QFileInfo>
#include <QSettings>

namespace {

QString readText(const char* key) {
  return QSettings().value(key).toString();
}

} // namespace

QString qSlicerFenestraApplicationSettings::findProgram(const QString& installed) {
  const QString chosen = readText(executableKey);
  return chosen.isEmpty() ? installed : chosen;
}

QStringList qSlicerFenestraApplicationSettings::makeThreadArguments() {
  const int threads = QSettings().value(threadsKey).toInt();
  return threads > 0 ? QStringList{QStringLiteral("--threads=%1").arg(threads)} : QStringList();
}

QStringList qSlicerFenestraApplicationSettings::makeDeviceArguments() {
  const QString device = readText(deviceKey);
  const bool isChosen = device == "cpu" || device == "gpu";
  return {"--device=" + (isChosen ? device : QStringLiteral("auto"))};
}

bool qSlicerFenestraApplicationSettings::isUsableFolder(const QString& folder) {
  const QFileInfo info(folder);
  return info.isDir() && info.isAbsolute() && info.isWritable();
}

QString qSlicerFenestraApplicationSettings::findTemporaryFolder() {
  const QString chosen = readText(temporaryFolderKey);
  if (isUsableFolder(chosen))
    return chosen;
  if (!chosen.isEmpty())
    qWarning().noquote() << "Fenestra: no files can be written to" << chosen
                         << "of the application settings; Slicer's temporary folder is used.";
  const qSlicerCoreApplication* application = qSlicerCoreApplication::application();
  return application ? application->temporaryPath() : QDir::tempPath();
}
